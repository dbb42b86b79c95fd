"""The layers of our files, and names as files may have them."""

LAYERS = ("outline", "keep-outs", "bodies", "apertures", "baselines", "labels")
OUTLINE, KEEP_OUTS, BODIES, APERTURES, BASELINES, LABELS = LAYERS

LONGEST_NAME = 100


def clean(name: str) -> str:
    """Give a name as one short line of printable characters."""
    return " ".join("".join(letter if letter.isprintable() else " " for letter in name).split())[:LONGEST_NAME].strip()
