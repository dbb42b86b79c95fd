"""Questions asked backwards: the fewest lenses, the smallest back or the smallest aperture that measure depth well enough."""
