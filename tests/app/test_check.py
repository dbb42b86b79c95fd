"""Bad input ends with exit code 2, one line that names the key, and no folder."""

from pathlib import Path

import pytest

from multilens.app.command import run_command

POLYGON = ["back=rectangle", "back.outline.kind=polygon", "back.outline.width=null", "back.outline.height=null"]
BOWTIE = "back.outline.points=[[0,0],[10,10],[10,0],[0,10]]"
HOLE_OUTSIDE = ["back.outline.points=[[0,0],[9,0],[9,9]]", "back.outline.holes=[[[20,20],[21,20],[21,21]]]"]

BAD = {
    "misspelt key": (["lenses.cout=3"], ["lenses.cout=3", "did you mean lenses.count?"]),
    "misspelt key with a plus": (["+lenses.cout=3"], ["lenses.cout", "did you mean lenses.count?"]),
    "misspelt preset": (["search=quik"], ["search=quik", "default, quick, thorough", "did you mean quick?"]),
    "misspelt experiment": (["experiment=dmeo"], ["did you mean demo?"]),
    "wrong type": (["lenses.count=abc"], ["lenses.count", "abc", "Integer"]),
    "word not in the list": (["depth.spacing=cubic"], ["depth.spacing", "cubic", "linear, log"]),
    "unknown cue": (["cues.names=[stereo,smell]"], ["cues.names", "smell"]),
    "no ring": (["field_of_view.rings=0"], ["field_of_view.rings", "from 1 to 1024", "got 0"]),
    "no cue": (["cues.names=[]"], ["cues.names", "none"]),
    "a sweep of nothing": (["-m", "lenses.count=range(1,1)"], ["lenses.count=range(1,1)", "one value at least"]),
    "a range without steps": (["-m", "lenses.count=range(1,3,0)"], ["lenses.count=range(1,3,0)", "zero"]),
    "no lens": (["lenses.count=0"], ["lenses.count", "from 1 to 64", "got 0"]),
    "many lenses": (["lenses.count=65"], ["lenses.count", "got 65"]),
    "NaN": (["lenses.lens.focal_length=nan"], ["lenses.lens: focal_length", "nan"]),
    "infinity": (["depth.near=inf"], ["depth.near", "inf"]),
    "nearer than can be computed": (["depth.near=1e-300"], ["depth.near", "1e-20", "got 1e-300"]),
    "far before near": (["depth.far=100"], ["depth.far", "depth.near = 200", "got 100"]),
    "no time": (["search.time_limit=0"], ["search.time_limit", "got 0"]),
    "no starts": (["search.starts=0"], ["search.starts", "got 0"]),
    "three coordinates": (["lenses.lens.position=[1,2,3]"], ["lenses.lens.position", "two numbers", "got 3"]),
    "bowtie": ([*POLYGON, BOWTIE], ["back.outline", "Self-intersection[5 5]"]),
    "NaN vertex": ([*POLYGON, "back.outline.points=[[0,0],[10,0],[nan,5]]"], ["back.outline: point 2", "nan"]),
    "huge vertex": ([*POLYGON, "back.outline.points=[[0,0],[10,0],[1e300,5]]"], ["back.outline: point 2", "1e+300"]),
    "endless vertex": (
        [*POLYGON, f"back.outline.points=[[0,0],[10,0],[1{400 * '0'},5]]"],
        ["points.2", "a float can hold"],
    ),
    "word for a vertex": ([*POLYGON, "back.outline.points=[[0,0],[x,0],[9,5]]"], ["back.outline.points.1", "'x'"]),
    "hole outside": ([*POLYGON, *HOLE_OUTSIDE], ["back.outline", "Hole lies outside shell"]),
    "field of another kind": (
        ["back=rectangle", "back.outline.corner=3"],
        ["back.outline.corner", "got corner; set back.outline.corner=null"],
    ),
    "polygon over a preset's shape": (
        ["back.outline={kind: polygon, points: [[0,0],[90,0],[90,90]]}"],
        ["set back.outline.corner=null back.outline.height=null back.outline.width=null"],
    ),
    "radius beside a preset's f-number": (
        ["lenses.lens.aperture_radius=[0.3,1]"],
        ["lenses.lens must have either", "got both; set the other to null, as in lenses.lens.f_number=null"],
    ),
    "an entry without a plus": (
        ["back.keep_outs={ir: {shape: {kind: disc, radius: 6}}}"],
        ["back.keep_outs.ir", "a + before the key adds it"],
    ),
    "neither radius nor f-number": (["lenses.lens.f_number=null"], ["lenses.lens must have either", "got neither"]),
    "a key taken away": (["~lenses.lens.f_number"], ["~lenses.lens.f_number", "set lenses.lens.f_number=null"]),
    "missing field": (["back=rectangle", "back.outline.width=null"], ["back.outline.width is missing"]),
    "negative clearance": (["back.keep_outs.flash.clearance=-1"], ["back.keep_outs.flash", "got -1"]),
    "class to call": (["_target_=numpy.load"], ["_target_", "unknown key"]),
    "class to call with a plus": (["+back._target_=numpy.load"], ["back._target_", "unknown key"]),
    "class to call in a value": (["+back={_target_:numpy.load}"], ["_target_", "unknown key"]),
    "Hydra's own part in a sweep": (["-m", "hydra.job.chdir=false,true"], ["hydra.job.chdir", "cannot be swept"]),
    "all of Hydra's part in a sweep": (["-m", "++hydra={verbose:false},{verbose:true}"], ["hydra", "cannot be swept"]),
    "a launcher in a sweep": (["-m", "hydra/launcher=basic,joblib"], ["hydra/launcher", "cannot be swept"]),
    "variables of the environment": (["++hydra.job.env_set.PATH=x"], ["hydra.job.env_set must be empty"]),
    "class for Hydra to call": (["hydra.launcher._target_=os.system"], ["hydra.launcher._target_"]),
    "log file in the run folder": (["hydra/job_logging=default"], ["hydra.job_logging", "logging.FileHandler"]),
    "Hydra's files in the run folder": (["hydra.output_subdir=x"], ["hydra.output_subdir", "got x"]),
    "name that climbs": (["name=../../x"], ["name", "'../../x'"]),
    "name with a slash": (["name=a/b"], ["name", "'a/b'"]),
    "name that is a folder": (["name=.."], ["name", "'..'"]),
    "sweep without -m": (["lenses.count=2,3"], ["lenses.count=2,3", "-m"]),
    "one value of a sweep": (["-m", "lenses.count=2,0"], ["lenses.count", "got 0"]),
    "one preset of a sweep": (["-m", "search=quick,quik"], ["search=quik", "did you mean quick?"]),
    "endless interpolation": (
        ["search.starts=${search.patience}", "search.patience=${search.starts}"],
        ["search.starts"],
    ),
    "not an override": (["lenses.count"], ["lenses.count", "key=value"]),
    "unknown flag": (["--bogus"], ["--bogus"]),
    "pickle": (["--experimental-rerun=x.pickle"], ["--experimental-rerun"]),
    "two ways to give lenses": (["lenses=main_and_tele", "lenses.count=3"], ["lenses.each", "lenses.count"]),
    "two ways to give apertures": (["lenses.lens.aperture_radius=[1,2]"], ["aperture_radius or f_number", "both"]),
    "plot of nothing": (["plot"], ["plot", "folder of a run or of a sweep"]),
    "plot of what is no run": (["plot", "nowhere"], ["nowhere", "design.json"]),
    "unknown key to print": (["--cfg", "job", "lenses.cout=3"], ["lenses.cout", "did you mean lenses.count?"]),
}


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(("given", "told"), BAD.values(), ids=BAD)
def test_bad_input_is_refused_in_one_line(
    given: list[str],
    told: list[str],
    elsewhere: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr("sys.argv", ["multilens", *given])
    assert run_command(given) == 2
    out, err = capsys.readouterr()
    assert err.startswith("multilens: ")
    assert err.count("\n") == 1
    assert [words for words in told if words not in err] == []
    assert out == ""
    assert list(elsewhere.iterdir()) == []


@pytest.mark.parametrize("flag", ["hydra.run.dir", "hydra.sweep.dir"])
def test_a_used_folder_is_refused(flag: str, elsewhere: Path, capsys: pytest.CaptureFixture[str]):
    used = elsewhere / "used"
    used.mkdir()
    (used / "kept.txt").write_text("kept")
    assert run_command([*(["-m"] if "sweep" in flag else []), f"{flag}={used}"]) == 2
    assert flag in capsys.readouterr().err
    assert [path.name for path in used.iterdir()] == ["kept.txt"]


def test_a_callable_in_a_users_file_is_refused(elsewhere: Path, capsys: pytest.CaptureFixture[str]):
    (elsewhere / "mine" / "experiment").mkdir(parents=True)
    text = "# @package _global_\nhydra: {callbacks: {x: {_target_: os.getcwd}}}\n"
    (elsewhere / "mine" / "experiment" / "foreign.yaml").write_text(text)
    assert run_command(["--config-dir=mine", "experiment=foreign"]) == 2
    assert "hydra.callbacks.x._target_" in capsys.readouterr().err


HANDLER = "{version: 1, handlers: {x: {class: this.x}}, root: {handlers: [x]}}"


@pytest.mark.parametrize(
    ("param", "told"),
    [
        (f'"++hydra": "{{verbose: false}},{{job_logging: {HANDLER}}}"', "hydra cannot be swept"),
        ('hydra.job.chdir: "false,true"', "hydra.job.chdir cannot be swept"),
        ('"+mine": "first,second"', "hydra.callbacks.x._target_"),
    ],
)
def test_what_a_sweep_in_a_users_file_would_set_of_hydras_is_refused(
    param: str, told: str, elsewhere: Path, capsys: pytest.CaptureFixture[str]
):
    for folder in ("experiment", "mine"):
        (elsewhere / "mine" / folder).mkdir(parents=True)
    text = f"# @package _global_\nhydra: {{mode: MULTIRUN, sweeper: {{params: {{{param}}}}}}}\n"
    (elsewhere / "mine/experiment/swept.yaml").write_text(text)
    (elsewhere / "mine/mine/first.yaml").write_text("# @package _global_\nname: first\n")
    (elsewhere / "mine/mine/second.yaml").write_text(
        "# @package _global_\nhydra: {callbacks: {x: {_target_: os.getcwd}}}\n"
    )
    assert run_command(["--config-dir=mine", "experiment=swept"]) == 2
    err = capsys.readouterr().err
    assert told in err
    assert err.count("\n") == 1
    assert [path.name for path in elsewhere.iterdir()] == ["mine"]


def test_variables_of_the_environment_in_a_users_file_are_refused(elsewhere: Path, capsys: pytest.CaptureFixture[str]):
    (elsewhere / "mine/experiment").mkdir(parents=True)
    text = "# @package _global_\nhydra: {job: {env_set: {PATH: here}}}\n"
    (elsewhere / "mine/experiment/foreign.yaml").write_text(text)
    assert run_command(["--config-dir=mine", "experiment=foreign"]) == 2
    assert "hydra.job.env_set must be empty" in capsys.readouterr().err


@pytest.mark.parametrize("stream", ["ext://this.s", "cfg://handlers", "${oc.env:STREAM}"])
def test_a_module_that_a_log_handler_would_import_is_refused(
    stream: str, elsewhere: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("STREAM", "ext://this.s")
    (elsewhere / "mine" / "hydra" / "job_logging").mkdir(parents=True)
    text = f"version: 1\nhandlers: {{console: {{class: logging.StreamHandler, stream: '{stream}'}}}}\n"
    (elsewhere / "mine" / "hydra" / "job_logging" / "foreign.yaml").write_text(text)
    assert run_command(["--config-dir=mine", "hydra/job_logging=foreign"]) == 2
    assert "hydra.job_logging.handlers.console.stream" in capsys.readouterr().err


@pytest.mark.parametrize("option", ["none", "stdout", "disabled"])
def test_hydras_own_logging_to_the_console_is_not_refused(option: str, capsys: pytest.CaptureFixture[str]):
    assert run_command([f"hydra/job_logging={option}", "search.starts=0"]) == 2
    assert "search.starts" in capsys.readouterr().err


def test_unknown_keys_are_refused_without_our_primary_file_too(elsewhere: Path, capsys: pytest.CaptureFixture[str]):
    (elsewhere / "mine").mkdir()
    text = "defaults: [override hydra/job_logging: none]\nhydra: {output_subdir: null}\nname: mine\nthing: {_target_: os.getcwd}\n"
    (elsewhere / "mine" / "config.yaml").write_text(text)
    assert run_command([f"--config-path={elsewhere / 'mine'}"]) == 2
    assert "thing" in capsys.readouterr().err
