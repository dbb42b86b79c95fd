"""From a configuration to the tolerance it names."""

from multilens.app.refusal import refused_at
from multilens.app.schema import ToleranceConfig
from multilens.tolerance import Tolerance


def build_tolerance(config: ToleranceConfig) -> Tolerance | None:
    """Make the tolerance; None where none is named."""
    if config.mm is None and config.percent is None:
        return None
    with refused_at("tolerance"):
        return Tolerance(config.mm, config.percent)
