"""Redo the thesis' two-lens study: tables and figures into results/, about a minute.

python experiments/thesis_two_lens/run.py
"""

import csv
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import torch
from figures import arrangements, errors_by_depth, valleys
from line import (
    EXTREMES,
    LONGEST,
    ROOM,
    Baseline,
    centre_to_centre,
    least_loss,
    polished_optimum,
    rim_to_rim,
    slide,
    switching_ratio,
)
from model import LENGTH, Arrangement, GradientDescent, arrangement, initial_thetas, iterates, loss
from solver import GapStereo, line_problem

import multilens as ml

RESULTS = Path(__file__).parent / "results"

RANGES = ((20, 50), (30, 70), (80, 120), (100, 200), (300, 500))
WIDER_RANGES = ((20, 500), (1, 1000))
"""Figure 5.4's, and one that stands for all: only far / near matters."""

PRINTED_GAP = (46.0, 11.734, 7.218, 0.972, 0.0)
PRINTED_DIAMETER = (2.0, 36.267, 40.779, 47.0276452262, 47.999)
PRINTED_FOCUS = (47.175, 53.071, 102.259, 160.959, 421.859)

F_DFDD = 50.0
"""mm; large enough for the penalty to hold the lenses to the line in every range."""

RATIOS = (6.0, 1.0)
"""f_stereo / f_dfdd: one that makes printed rows 1 and 5 optimal at once, and equal focal lengths."""

SEEDS, DEPTHS, FEWER_DEPTHS = 20, 200, 50
"""Descents and slides are seen at fewer depths, which moves nothing by more than a percent; every loss is taken at all."""

DESCENT = GradientDescent(iterations=10_000, step=8e-5, fading=True)

SCANNED_RATIOS, SCANNED_F, SCANNED_SEEDS = (1.0, 2.0, 4.0, 6.0), (1.0, 10.0, 50.0), 8
SCANNED = (GradientDescent(1000, 1e-5), GradientDescent(1000, 1e-4), GradientDescent(3500, 1e-2, adam=True))

CHECKED_RATIOS = (*range(1, 13), 15, 20, 30)


def range_depths(count: int) -> torch.Tensor:
    return torch.stack([ml.linear_depths(near, far, count) for near, far in RANGES])


def printed() -> Arrangement:
    gap, focus, diameter = (
        torch.tensor(t, dtype=torch.float64) for t in (PRINTED_GAP, PRINTED_FOCUS, PRINTED_DIAMETER)
    )
    return Arrangement(gap, focus, diameter / 2)


def on_line(gap: torch.Tensor, focus: torch.Tensor) -> Arrangement:
    return Arrangement(gap, focus, (ROOM - gap) / 2)


def solved(depths: torch.Tensor, ratio: float, stereo: ml.PairStereo | GapStereo) -> Arrangement:
    design = ml.solve(line_problem(depths, ratio, stereo), starts=32, seed=0, patience=2)
    assert design.feasible, design.reason
    radius = design.layout.aperture_radius
    apart = (design.layout.position[0] - design.layout.position[1]).norm()
    return Arrangement(apart - radius.sum(), design.layout.focus[1, 0], radius[1])


def descents() -> torch.Tensor:
    """Theta after the last iteration, [ratio, range, seed, 3]."""
    depths = range_depths(FEWER_DEPTHS)[:, None]
    theta = initial_thetas(SEEDS).expand(len(RATIOS), len(RANGES), SEEDS, 3)
    f_stereo = F_DFDD * torch.tensor(RATIOS).double()[:, None, None, None]
    for last in iterates(theta, depths, f_stereo, F_DFDD, DESCENT):
        theta = last
    return theta


def row(k: int, ratio: float, what: str, lenses: Arrangement, cost: float, optimum: float) -> dict[str, object]:
    near, far = RANGES[k]
    return {
        "near": near,
        "far": far,
        "ratio": ratio,
        "what": what,
        "gap": round(float(lenses.gap), 6),
        "aperture_diameter": round(2 * float(lenses.aperture_radius), 6),
        "focus": round(float(lenses.focus), 6),
        "length_used": round(float(lenses.length_used), 6),
        "loss": f"{cost:.9g}",
        "of_optimum": round(cost / optimum, 6),
    }


def five_ranges(thetas: torch.Tensor) -> list[dict[str, object]]:
    rows = []
    for at, ratio in enumerate(RATIOS):
        for k, depths in enumerate(range_depths(DEPTHS)):

            def cost(lenses: Arrangement, depths: torch.Tensor = depths, ratio: float = ratio) -> torch.Tensor:
                return loss(lenses, depths, ratio * F_DFDD, F_DFDD)

            best = polished_optimum(depths, ratio)
            optimum = on_line(best.gap, best.focus)
            least = cost(optimum).item()
            ends = arrangement(thetas[at, k], depths)
            costs = cost(ends)
            order = costs.argsort()
            shown = {
                "printed": Arrangement(*(column[k] for column in vars(printed()).values())),
                "descent, best of 20": Arrangement(*(column[order[0]] for column in vars(ends).values())),
                "descent, median of 20": Arrangement(*(column[order[SEEDS // 2]] for column in vars(ends).values())),
                "exhaustive": optimum,
                "multilens": solved(depths, ratio, GapStereo()),
            }
            rows += [row(k, ratio, what, lenses, cost(lenses).item(), least) for what, lenses in shown.items()]
    return rows


def spread(thetas: torch.Tensor) -> list[dict[str, object]]:
    """Least, quartiles and largest of the gap and of the focus at which the seeds end."""
    at = torch.tensor([0, 0.25, 0.5, 0.75, 1], dtype=torch.float64)
    rows = []
    for a, ratio in enumerate(RATIOS):
        for (near, far), theta, depths in zip(RANGES, thetas[a], range_depths(DEPTHS), strict=True):
            ends = arrangement(theta, depths)
            one: dict[str, object] = {"near": near, "far": far, "ratio": ratio}
            for name, column in (("gap", ends.gap), ("focus", ends.focus)):
                values = zip(("least", "quarter", "median", "three_quarters", "most"), column.quantile(at), strict=True)
                one |= {f"{name}_{which}": round(value.item(), 2) for which, value in values}
            rows.append(one | {"farthest_from_line": f"{(ends.length_used - LENGTH).abs().max():.1e}"})
    return rows


def five_ranges_by_centres() -> list[dict[str, object]]:
    rows = []
    ratio = RATIOS[0]
    for k, depths in enumerate(range_depths(DEPTHS)):
        best = polished_optimum(depths, ratio, centre_to_centre)
        problem = line_problem(depths, ratio, ml.PairStereo(), F_DFDD)
        least = best.loss.item() / F_DFDD**2
        shown = {
            "printed": Arrangement(*(column[k] for column in vars(printed()).values())),
            "exhaustive": on_line(best.gap, best.focus),
            "multilens": solved(depths, ratio, ml.PairStereo()),
        }
        for what, lenses in shown.items():
            radius, focus = lenses.aperture_radius.item(), lenses.focus.item()
            place = [[1.0, 25.0], [2.0 + lenses.gap.item() + radius, 25.0]]
            score = problem.score(ml.Layout(place, [1.0, radius], [focus, focus])).item()
            rows.append(row(k, ratio, what, lenses, score, least))
    return rows


def switching() -> list[dict[str, object]]:
    rows = []
    gap = torch.linspace(0, LONGEST, 47, dtype=torch.float64)
    for near, far in (*RANGES, *WIDER_RANGES):
        depths = ml.linear_depths(near, far, DEPTHS)
        entry: dict[str, object] = {"near": near, "far": far, "far_over_near": round(far / near, 3)}
        bases: tuple[tuple[str, Baseline], ...] = (("gap", rim_to_rim), ("centres", centre_to_centre))
        for name, baseline in bases:
            entry[f"switch_{name}"] = round(switching_ratio(depths, baseline), 3)
            between = []
            for ratio in CHECKED_RATIOS:
                inner = least_loss(gap[1:-1], depths, ratio, 41, baseline).loss.min()
                between.append((inner / least_loss(EXTREMES, depths, ratio, 401, baseline).loss.min()).item())
            entry[f"least_between_{name}"] = round(min(between), 4)
        at_switch = least_loss(gap, depths, switching_ratio(depths))
        entry["ridge_at_switch"] = round((at_switch.loss.max() / at_switch.loss.min()).item(), 3)
        entry["least_from_5_to_40"] = round((at_switch.loss[5:41].min() / at_switch.loss.min()).item(), 3)
        rows.append(entry)
    return rows


def meets_line(theta: torch.Tensor) -> torch.Tensor:
    """The gap at which the first, penalty-driven rise from a start meets the line: both thetas grow as 46 to 48."""
    grown = (ROOM - LONGEST * theta[..., 0] - ROOM * theta[..., 2]) / (LONGEST**2 + ROOM**2)
    return LONGEST * (theta[..., 0] + LONGEST * grown)


def slides() -> list[dict[str, object]]:
    """When and with which focus a descent of vanishing step passes each printed gap, and where it ends."""
    ratios, theta = (1.0, 4.0, 6.0), initial_thetas(SEEDS)
    depths = range_depths(FEWER_DEPTHS)
    near, far = depths[:, :1], depths[:, -1:]
    shape = (len(ratios), len(RANGES), SEEDS)
    gap = meets_line(theta).expand(shape)
    focus = (near + (far - near) * theta[:, 1]).expand(shape)
    ratio = torch.tensor(ratios).double()[:, None, None].expand(shape)
    time, gap, focus = slide(gap, focus, depths[:, None].expand(*shape, FEWER_DEPTHS), ratio, 1200)
    rows = []
    for at, value in enumerate(ratios):
        for k in range(len(RANGES)):
            b, t, f = (column[:, at, k] for column in (gap, time, focus))
            passed = b >= PRINTED_GAP[k] - 0.01 if PRINTED_GAP[k] == LONGEST else b <= PRINTED_GAP[k] + 0.01
            does, first = passed.any(0), passed.double().argmax(0, keepdim=True)
            when, where = t.gather(0, first)[0][does], f.gather(0, first)[0][does]
            one = {"near": RANGES[k][0], "far": RANGES[k][1], "ratio": value, "printed_gap": PRINTED_GAP[k]}
            one |= {"runs_that_pass": int(does.sum())}
            one |= {
                "first_time": f"{when.min():.3g}" if len(when) else "",
                "last_time": f"{when.max():.3g}" if len(when) else "",
            }
            one |= {
                "median_focus_then": round(where.median().item(), 3) if len(where) else "",
                "printed_focus": PRINTED_FOCUS[k],
            }
            rows.append(one | {"end_at_0": int((b[-1] < 0.5).sum()), "end_at_46": int((b[-1] > 45).sum())})
    return rows


def scan() -> list[dict[str, object]]:
    """For each setting the iteration at which the median gaps of the runs are nearest to the printed ones."""
    ratio = torch.tensor(SCANNED_RATIOS).double()[:, None, None, None, None]
    f_dfdd = torch.tensor(SCANNED_F).double()[:, None, None, None]
    theta = initial_thetas(SCANNED_SEEDS).expand(len(SCANNED_RATIOS), len(SCANNED_F), len(RANGES), SCANNED_SEEDS, 3)
    target = torch.tensor(PRINTED_GAP, dtype=torch.float64)
    rows = []
    for settings in SCANNED:
        path = iterates(theta, range_depths(40)[:, None], ratio * f_dfdd, f_dfdd, settings)
        kept = [(i, LONGEST * now[..., 0]) for i, now in enumerate(path, 1) if i <= 100 or i % (i // 50) == 0]
        middle = torch.stack([gaps for _, gaps in kept]).median(-1).values
        off = (middle - target).abs()
        for name, rows_used in (("all five", slice(0, 5)), ("rows 2-5", slice(1, 5))):
            flat = off[..., rows_used].amax(-1)
            at, a, c = (int(n) for n in torch.unravel_index(flat.argmin(), flat.shape))
            gaps = middle[at, a, c].tolist()
            rows.append(
                {
                    "optimiser": "Adam" if settings.adam else "plain",
                    "step": settings.step,
                    "judged_by": name,
                    "ratio": SCANNED_RATIOS[a],
                    "f_dfdd": SCANNED_F[c],
                    "iteration": kept[at][0],
                    "largest_miss": round(flat[at, a, c].item(), 2),
                }
                | {f"gap_{near}_{far}": round(gap, 2) for (near, far), gap in zip(RANGES, gaps, strict=True)}
            )
    return rows


def write_csv(name: str, rows: list[dict[str, object]]) -> None:
    with (RESULTS / f"{name}.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def as_markdown(title: str, rows: list[dict[str, object]]) -> str:
    lines = [f"## {title}", "", "| " + " | ".join(rows[0]) + " |", "|---" * len(rows[0]) + "|"]
    lines += ["| " + " | ".join(str(value) for value in row.values()) + " |" for row in rows]
    return "\n".join([*lines, ""])


def main() -> None:
    torch.set_num_threads(1)  # the tensors are small: handing them to a second core costs more than it brings
    RESULTS.mkdir(exist_ok=True)
    thetas = descents()
    tables = {
        "table": ("The five ranges, baseline from rim to rim as in the thesis", five_ranges(thetas)),
        "spread": ("Where the 20 descents end", spread(thetas)),
        "centres": ("The five ranges, baseline from centre to centre", five_ranges_by_centres()),
        "switching": ("Where each range switches, and what lies between the extremes", switching()),
        "slide": ("Descent of vanishing step along the line", slides()),
        "scan": ("Settings that pass nearest to the printed gaps", scan()),
    }
    for name, (_, rows) in tables.items():
        write_csv(name, rows)
    text = "\n".join(as_markdown(title, rows) for title, rows in tables.values())
    (RESULTS / "table.md").write_text(
        f"# Results\n\nLengths in mm, losses in mm^2 at f_dfdd = {F_DFDD:g} mm.\n\n{text}"
    )
    ends = [arrangement(thetas[0, k], depths) for k, depths in enumerate(range_depths(DEPTHS))]
    profiles = [
        least_loss(torch.linspace(0, LONGEST, 185, dtype=torch.float64), depths, RATIOS[0])
        for depths in range_depths(DEPTHS)
    ]
    figures = {
        "errors_by_depth": errors_by_depth(),
        "arrangements": arrangements(tables["table"][1], RANGES, LENGTH),
        "valleys": valleys(RANGES, profiles, PRINTED_GAP, [end.gap for end in ends], RATIOS[0]),
    }
    for name, figure in figures.items():
        figure.savefig(RESULTS / f"{name}.png", dpi=150)
        figure.savefig(RESULTS / f"{name}.svg", metadata={"Date": None})


if __name__ == "__main__":
    main()
