"""The formulae of stereo and defocus: pure functions of tensors, each one line of physics."""
