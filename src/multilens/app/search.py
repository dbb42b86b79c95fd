"""The search with the settings of a configuration."""

from typing import TYPE_CHECKING

from multilens.app.schema import Config, PenaltyName

if TYPE_CHECKING:
    from multilens.design import Design
    from multilens.question import Question
    from multilens.search.progress import Listener


class NothingFoundError(Exception):
    """The search ended without a design; the message is the reason."""


def search(question: "Question", config: Config, listener: "Listener", proof: int | None = None) -> "Design":
    """Search as a configuration says.

    Args:
        question: what is asked.
        config: whose search and penalty are taken.
        listener: told of the progress.
        proof: boxes that the lower bound may look at; None takes the configuration's.

    Raises:
        NothingFoundError: no start stayed healthy.
    """
    from multilens.penalty import area_penalty, distance_penalty
    from multilens.search.solve import solve

    penalties = {PenaltyName["distance"]: distance_penalty, PenaltyName["area"]: area_penalty}
    asked = config.search
    try:
        return solve(
            question,
            starts=asked.starts,
            seed=asked.seed,
            time_limit=asked.time_limit,
            patience=asked.patience,
            proof=asked.proof if proof is None else proof,
            penalty=penalties[config.penalty.name],
            listener=listener,
        )
    except RuntimeError as error:
        # Of its own accord solve raises this when no start stays healthy; any other is a fault and keeps its traceback.
        if "stayed healthy" not in str(error):
            raise
        raise NothingFoundError(str(error)) from None
