"""The cluster route on a real Slurm of two nodes, which `slurm.py` starts on this machine.

The commands of docs/cluster.md that need a cluster are run here, on few and small designs, and not by test_docs.py.
"""

import json
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from time import monotonic, sleep

import pytest
from tests.cluster.slurm import missing, two_nodes

PAGE = Path(__file__).parents[2] / "docs/cluster.md"

# One cluster for all of them.
pytestmark = pytest.mark.xdist_group("slurm")

SMALL = ["depth.count=8", "search.starts=2", "search.patience=0", "search.proof=1", "search.seed=0"]
FEW = ["lenses.count=1,2", "back.outline.width=45,12", "back.outline.height=46", "back.outline.corner=4"]
"""Four jobs in place of 10,000; on a back 12 mm wide no lens has room."""

NODE = ["partition=main", "timeout_min=5", "mem_gb=1", "cpus_per_task=1"]
BROKEN = "torch is not installed on this node"
SAME = ("config.yaml", "design.json", "layout.csv", "sensitivity.csv")
"""Files of a job that tell no time."""

SECONDS = 200.0
"""A sweep takes 15; a job that was killed would be waited for without end."""

Done = subprocess.CompletedProcess[str]


@pytest.fixture(scope="module")
def slurm(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    lacking = missing() + [name for name in ("submitit",) if find_spec(name) is None]
    if lacking:
        # The continuous integration installs it: a test skipped there would be one that nobody runs.
        end = pytest.fail if os.environ.get("CI") else pytest.skip
        end(f"no Slurm on this machine, {', '.join(lacking)} not installed")
    with two_nodes(tmp_path_factory.mktemp("slurm")) as environment:
        yield environment


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("sweeps")


def sweep(environment: dict[str, str], place: Path, *words: str) -> Done:
    command = [sys.executable, "-c", "from multilens.app import main; main()", *words]
    return subprocess.run(command, cwd=place, env=environment, capture_output=True, text=True, timeout=SECONDS)


def small(folder: str, *words: str) -> list[str]:
    """Give the sweep of the page with few and small jobs, on nodes of the size that there are."""
    text = PAGE.read_text(encoding="utf-8").replace("\\\n", "")
    (line,) = re.findall(r"(?m)^multilens (-m .*submitit_slurm.*)$", text)
    nodes = [f"hydra.launcher.{each}" for each in NODE]
    return [*shlex.split(line), *SMALL, *FEW, *nodes, f"hydra.sweep.dir={folder}", *words]


@pytest.fixture(scope="module")
def done(slurm: dict[str, str], place: Path) -> Done:
    return sweep(slurm, place, *small("nodes"))


def rows(folder: Path) -> list[dict]:
    return [json.loads(line) for line in (folder / "table.jsonl").read_text().splitlines()]


def test_a_sweep_on_a_cluster_ends_with_its_table(done: Done, place: Path):
    assert "nodes/table.csv" in done.stdout.splitlines(), done.stderr
    assert [row["status"] for row in rows(place / "nodes")] == ["complete", "infeasible"] * 2


def test_a_job_that_finds_nothing_is_told_by_the_exit_code(done: Done):
    assert done.returncode == 3


def test_both_nodes_work(done: Done, slurm: dict[str, str]):
    told = subprocess.run(["scontrol", "--oneliner", "show", "job"], env=slurm, capture_output=True, text=True)
    assert set(re.findall(r" NodeList=(\w+)", told.stdout)) == {"n1", "n2"}


def test_designs_are_those_of_one_process(done: Done, slurm: dict[str, str], place: Path):
    here = [word for word in small("here", "hydra/launcher=basic") if not word.startswith("hydra.launcher.")]
    assert sweep(slurm, place, *here).returncode == 3
    timeless = [[row | {"time_s": None} for row in rows(place / name)] for name in ("nodes", "here")]
    assert timeless[0] == timeless[1]
    for job, name in ((job, name) for job in "02" for name in SAME):
        assert (place / "nodes" / job / name).read_bytes() == (place / "here" / job / name).read_bytes()


@pytest.fixture(scope="module")
def broken(slurm: dict[str, str], place: Path) -> Done:
    """Run two jobs of which the second finds no torch on its node."""
    (place / "broken").mkdir()
    (place / "broken/torch.py").write_text(f"raise ImportError({BROKEN!r})")
    breaks = f'[ "$SLURM_ARRAY_TASK_ID" != 1 ] || export PYTHONPATH={place}/broken'
    return sweep(slurm, place, *small("mended", "lenses.count=1", f"hydra.launcher.setup=['{breaks}']"))


def test_a_process_that_raises_leaves_the_others_their_results(broken: Done, place: Path):
    assert (broken.returncode, broken.stderr.count(BROKEN)) == (1, 1)
    assert (place / "mended/0/row.json").exists()
    assert not (place / "mended/1").exists()


def test_the_same_command_again_computes_what_is_missing_alone(broken: Done, slurm: dict[str, str], place: Path):
    before = (place / "mended/0/row.json").stat().st_mtime_ns
    sweep(slurm, place, *small("mended", "lenses.count=1"))
    assert [row["status"] for row in rows(place / "mended")] == ["complete", "infeasible"]
    assert (place / "mended/0/row.json").stat().st_mtime_ns == before


def daemons(folder: Path) -> list[str]:
    """Give the daemons of the cluster in a folder that are alive."""
    alive = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            name, environment = (process / "comm").read_text().strip(), (process / "environ").read_bytes()
        except OSError:
            continue
        if name in ("munged", "slurmctld", "slurmd") and f"SLURM_CONF={folder}/".encode() in environment:
            alive.append(name)
    return sorted(alive)


def test_a_cluster_ends_with_whoever_started_it(slurm: dict[str, str], tmp_path: Path):
    command = [sys.executable, Path(__file__).with_name("slurm.py"), "sh", "-c", 'echo "$SLURM_CONF"; cat']
    around, pipe = os.environ | {"TMPDIR": str(tmp_path)}, subprocess.PIPE
    with subprocess.Popen(command, env=around, stdin=pipe, stdout=pipe, text=True) as process:
        assert process.stdout is not None
        folder = Path(process.stdout.readline().strip()).parent
        assert daemons(folder) == ["munged", "slurmctld", "slurmd", "slurmd"]
        process.kill()
    end = monotonic() + 30
    while daemons(folder) and monotonic() < end:
        sleep(0.1)
    assert daemons(folder) == []
