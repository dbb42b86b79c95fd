"""What only a process of its own shows: what is loaded, and how signals end it."""

import os
import signal
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep

import pytest

MAIN = "from multilens.app import main; main()"


def test_help_loads_nothing_heavy(tmp_path: Path):
    asked = (
        "import sys\nfrom multilens.app import main\nsys.argv = ['multilens', '--help']\n"
        "try: main()\nexcept SystemExit as left: assert left.code == 0\n"
        "heavy = {'torch', 'shapely', 'scipy', 'matplotlib', 'numpy', 'hydra', 'omegaconf', 'rich', 'multilens.app.build'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", asked], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
    assert "multilens design experiment=demo" in done.stdout
    assert "penalty: area, distance" in done.stdout


def test_importing_the_package_loads_nothing_heavy():
    asked = "import sys, multilens; print(sorted({'torch', 'numpy', 'multilens.problem', 'hydra'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_output_that_nobody_reads_ends_quietly(tmp_path: Path):
    began = [sys.executable, "-c", MAIN, "--help"]
    with subprocess.Popen(began, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert (process.stderr.read(), process.wait(timeout=60)) == ("", 141)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_ends_a_run_with_one_line_and_no_folder(number: signal.Signals, code: int, tmp_path: Path):
    began = [sys.executable, "-c", MAIN, "search=thorough"]
    process = subprocess.Popen(began, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    end = monotonic() + 60
    while not (tmp_path / "runs").exists() and process.poll() is None and monotonic() < end:
        sleep(0.02)
    sleep(0.5)
    os.kill(process.pid, number)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (code, "")
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
