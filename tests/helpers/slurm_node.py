"""A Slurm of one node on this machine: no systemd, no cgroups, no accounting.

Its files lie in a folder of its own but for /etc/slurm and munge's, where its commands look for
them; it ends the daemons that it started, by their process ids, and no others.
"""

import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path

PACKAGES = ("slurm-wlm", "munge")
COMMANDS = ("slurmctld", "slurmd", "sbatch", "scancel", "scontrol", "sinfo", "squeue", "munged")
CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=2,sched_interval=5
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=task=2
JobAcctGatherParams=OverMemoryKill
AccountingStorageType=accounting_storage/none
ReturnToService=2
SlurmdTimeout=30
KillWait=5
MinJobAge=7200
DefMemPerCPU=1000
NodeName={host} CPUs={cpus} Boards=1 SocketsPerBoard=1 CoresPerSocket={cpus} ThreadsPerCore=1 \
RealMemory={memory_mb} State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
"""
_PATIENCE_S = 60


def find_lack():
    """Install Slurm where it is missing and start it once; return why not, or nothing."""
    if os.getuid() != 0:
        return "only root may start one"
    if missing_commands() and not _is_installed():
        return f"no {' and '.join(PACKAGES)} can be installed"
    if missing := missing_commands():
        return f"{' and '.join(PACKAGES)} are installed without {', '.join(missing)}"
    with tempfile.TemporaryDirectory() as folder:
        node = SlurmNode(folder)
        try:
            node.start()
        except (OSError, TimeoutError) as error:
            return f"its daemons do not start: {error}"
        finally:
            node.stop()
    return ""


def missing_commands():
    return [name for name in COMMANDS if shutil.which(name) is None]


def _is_installed():
    """Install Slurm, where this is a Debian, and return whether it is there."""
    if shutil.which("apt-get") is None:
        return False
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    install = ["apt-get", "install", "-y", "-qq", "--no-install-recommends", *PACKAGES]
    subprocess.run(["apt-get", "update", "-qq"], **quiet)
    return subprocess.run(install, **quiet).returncode == 0


class SlurmNode:
    """A cluster of this machine alone, from `start` until `stop`."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.host = socket.gethostname().partition(".")[0]
        self._daemons = []

    def start(self, n_cpus=2, memory_mb=None):
        for name in ("state", "spool"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        text = CONFIGURATION.format(
            host=self.host,
            folder=self.folder,
            cpus=n_cpus,
            memory_mb=memory_mb or _memory_mb(),
        )
        Path("/etc/slurm").mkdir(exist_ok=True)
        Path("/etc/slurm/slurm.conf").write_text(text)
        self._start_munge()
        self._begin("slurmctld", "-D")
        self._begin("slurmd", "-D", "-N", self.host)
        until_s = time.monotonic() + _PATIENCE_S
        while "idle" not in _output("sinfo", "--noheader", "--format=%T"):
            if time.monotonic() > until_s:
                raise TimeoutError((self.folder / "slurmctld.log").read_text()[-2000:])
            time.sleep(0.5)

    def _start_munge(self):
        owned = [Path(f"/{place}/munge") for place in ("run", "etc", "var/lib", "var/log")]
        for folder in owned:
            folder.mkdir(parents=True, exist_ok=True)
        key = Path("/etc/munge/munge.key")
        if not key.exists() or key.stat().st_size == 0:
            key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        for place in (*owned, key):
            shutil.chown(place, "munge", "munge")
            if place != key:
                place.chmod(0o755 if place == owned[0] else 0o700)
        if "Success" not in _output("munge", "--no-input", "--output=/dev/null") + _output(
            "sh", "-c", "munge -n | unmunge"
        ):
            self._begin("runuser", "-u", "munge", "--", "munged", "--foreground", "--force")
            time.sleep(1)

    def _begin(self, *command):
        with (self.folder / f"{Path(command[0]).name}.out").open("w") as said:
            self._daemons.append(
                subprocess.Popen(command, stdout=said, stderr=said, start_new_session=True)
            )

    def command(self, *words):
        return _output(*words)

    def stop(self):
        for daemon in reversed(self._daemons):
            with_children = daemon.pid
            try:
                os.killpg(with_children, signal.SIGTERM)
                daemon.wait(timeout=20)
            except ProcessLookupError:
                continue
            except subprocess.TimeoutExpired:
                os.killpg(with_children, signal.SIGKILL)
                daemon.wait()
        self._daemons.clear()


def _memory_mb():
    """Return what the node has, less what the machine itself needs."""
    pages, size = os.sysconf("SC_PHYS_PAGES"), os.sysconf("SC_PAGE_SIZE")
    return pages * size // 2**20 - 512


def _output(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    return done.stdout + done.stderr


if __name__ == "__main__" and (lack := find_lack()):
    print(f"the profile for Slurm is not tested: {lack}")
    raise SystemExit(1)
