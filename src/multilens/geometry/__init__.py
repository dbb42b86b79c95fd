"""Shapes on the back of a device: exact in shapely, differentiable in torch, and how the two meet."""
