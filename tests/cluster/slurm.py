"""A real Slurm of two nodes on this one machine: `python tests/cluster/slurm.py COMMAND ...` runs a command on it.

It has a folder, a key and free ports of its own, hears the loopback alone, and needs no systemd, no cgroups and no database. Its
daemons are children of this process and end with it, also where it is killed.
"""

import getpass
import os
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, sleep

NODES = ("n1", "n2")
PROGRAMS = ("munged", "munge", "slurmctld", "slurmd", "sbatch", "srun", "setpriv")
PATH = os.environ.get("PATH", os.defpath) + ":/usr/sbin:/sbin"
"""Daemons stand where only the administrator's search path leads."""

PATIENCE = 60.0
"""s to wait for what takes a second or two on an idle machine."""


def missing() -> list[str]:
    """Give the programs that a cluster needs and this machine lacks."""
    return [name for name in PROGRAMS if shutil.which(name, path=PATH) is None]


@contextmanager
def two_nodes(folder: Path) -> Iterator[dict[str, str]]:
    """Start the cluster, give the environment in which commands find it, and stop it with all its jobs.

    Args:
        folder: empty, for its key, its state and its logs; a socket lies in it, so its path must be short.
    """
    environment = os.environ | {"SLURM_CONF": str(folder / "slurm.conf"), "PATH": PATH}
    key, munge = folder / "munge.key", folder / "munge.socket"
    key.write_bytes(os.urandom(128))
    key.chmod(0o600)
    (folder / "slurm.conf").write_text(configuration(folder))
    for name in ("state", *(f"spool.{node}" for node in NODES)):
        (folder / name).mkdir()
    files = [f"--{what}={folder / 'munged'}.{what[:-5]}" for what in ("pid-file", "log-file", "seed-file")]
    with ExitStack() as stack:
        stack.enter_context(
            _daemon(environment, "munged", "--foreground", "--force", f"--socket={munge}", f"--key-file={key}", *files)
        )
        _wait(lambda: _says(environment, "munge", "--no-input", f"--socket={munge}").startswith("MUNGE:"), folder)
        for command in (["slurmctld"], *(["slurmd", "-N", node] for node in NODES)):
            stack.enter_context(_daemon(environment, *command, "-D"))
        _wait(lambda: _says(environment, "sinfo", "-h", "-N", "-o", "%T").split() == ["idle"] * len(NODES), folder)
        try:
            yield environment
        finally:
            _says(environment, "scancel", "--full", "--user", getpass.getuser())
            _wait(lambda: not _says(environment, "squeue", "-h").strip(), folder)


def configuration(folder: Path) -> str:
    """Give slurm.conf: two nodes of a core and 2 GB, whatever the machine has."""
    host, user, (control, *ports) = socket.gethostname(), getpass.getuser(), free_ports(1 + len(NODES))
    return f"""\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={control}
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmUser={user}
SlurmdUser={user}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=60
{_node_lines(host, ports)}
PartitionName=main Nodes={",".join(NODES)} Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count: int) -> list[int]:
    """Give ports of the loopback that nothing listens on."""
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]


def _node_lines(host: str, ports: Sequence[int]) -> str:
    return "\n".join(
        f"NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=1 RealMemory=2000 State=UNKNOWN"
        for node, port in zip(NODES, ports, strict=True)
    )


@contextmanager
def _daemon(environment: dict[str, str], *command: str) -> Iterator[None]:
    # A Ctrl-C on the terminal is for whoever started the cluster, which then ends it in good order.
    process = subprocess.Popen(
        ["setpriv", "--pdeathsig", "KILL", *command],
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        yield
    finally:
        process.terminate()
        try:
            process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def _says(environment: dict[str, str], *command: str) -> str:
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=PATIENCE)
    return done.stdout if done.returncode == 0 else ""


def _wait(is_so, folder: Path) -> None:
    end = monotonic() + PATIENCE
    while not is_so():
        if monotonic() > end:
            logs = "\n".join(f"{log.name}:\n{log.read_text()[-2000:]}" for log in sorted(folder.glob("*.log")))
            raise TimeoutError(f"Slurm was not ready within {PATIENCE:g} s\n{logs}")
        sleep(0.1)


if __name__ == "__main__":
    with TemporaryDirectory(prefix="slurm-") as place, two_nodes(Path(place)) as around:
        sys.exit(subprocess.run(sys.argv[1:], env=around).returncode)
