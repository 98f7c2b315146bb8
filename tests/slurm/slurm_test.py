"""A suite on a real Slurm of one node: submitted, a task killed and queued again, merged, nothing lost or doubled."""
import argparse
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time

SKIPPED = 77
SUITE = """
name = "cluster"
sizes = ["24x18"]
frames = 1
warmup = 0
reference = {spp = 2}
term = "visibility"
[[scenes]]
scene = "balls"
lights = ["key"]
light_sizes = [0.3, 0.6, 0.9]
max_masked_share = 0.3
[[techniques]]
technique = "hard_shadow_map"
[[techniques]]
technique = "pcf"
"""
ROWS = 6
# Seconds that a credential lasts, and that Slurm waits before it starts again what was queued again (120 by default).
EXPIRY = 20
CONF = """
ClusterName=limn
SlurmctldHost={host}
SlurmctldPort={port}
SlurmdPort={next}
AuthType=auth/munge
AuthInfo=socket={scratch}/munge.socket,cred_expire={expiry}
CredType=cred/munge
SlurmUser=root
StateSaveLocation={scratch}/state
SlurmdSpoolDir={scratch}/spool
SlurmctldPidFile={scratch}/slurmctld.pid
SlurmdPidFile={scratch}/slurmd.pid
SlurmctldLogFile={scratch}/slurmctld.log
SlurmdLogFile={scratch}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
NodeName={host} CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""

parser = argparse.ArgumentParser()
for option in ("limn", "scratch"):
    parser.add_argument("--" + option, required=True)
options = parser.parse_args()
tools = ("slurmctld", "slurmd", "sbatch", "munged")
missing = [tool for tool in tools if shutil.which(tool, path=os.environ["PATH"] + ":/usr/sbin") is None]
if missing or os.geteuid() != 0:
    print(f"skipped: no {', '.join(missing)} (Debian packages slurm-wlm, munge)" if missing else "skipped: Slurm runs as root only")
    sys.exit(SKIPPED)

scratch = pathlib.Path(options.scratch).resolve()
out = scratch / "out"
started = []


def check(condition, message):
    if not condition:
        logs = "".join(f"\n--- {log.name}\n{log.read_text(errors='replace')[-1500:]}" for log in sorted(scratch.rglob("*.log")))
        sys.exit(f"FAILED: {message}{logs}")


def start(*command, **how):
    started.append(subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **how))


def happens(seconds, condition):
    end = time.time() + seconds
    while not condition():
        if time.time() > end:
            return False
        time.sleep(0.5)
    return True


def wait_for(what, seconds, condition):
    check(happens(seconds, condition), f"{what}: not within {seconds} s")


def need(what, seconds, condition):
    """What a machine may lack, such as a name of its own that resolves, is no fault of limn."""
    if not happens(seconds, condition):
        print(f"skipped: Slurm does not start here: no {what} within {seconds} s")
        sys.exit(SKIPPED)


def said(*command):
    return subprocess.run(command, capture_output=True, text=True).stdout


def start_cluster():
    shutil.rmtree(scratch, ignore_errors=True)
    for folder in ("state", "spool", "munge"):
        (scratch / folder).mkdir(parents=True)
    for folder in (scratch, *scratch.parents):  # munged refuses what others may write
        if folder.stat().st_mode & 0o002 and not folder.stat().st_mode & 0o1000:
            print(f"skipped: everybody may write {folder}")
            sys.exit(SKIPPED)
    key = scratch / "munge" / "key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o600)
    start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={scratch}/munge.socket",
          f"--pid-file={scratch}/munge/pid", f"--log-file={scratch}/munge/munged.log", f"--seed-file={scratch}/munge/seed")
    need("munged", 20, (scratch / "munge.socket").exists)
    with socket.socket() as free:
        free.bind(("", 0))
        port = free.getsockname()[1]
    conf = scratch / "slurm.conf"
    conf.write_text(CONF.format(host=socket.gethostname().split(".")[0], port=port, next=port + 1, scratch=scratch,
                                cpus=os.cpu_count(), expiry=EXPIRY))
    os.environ["SLURM_CONF"] = str(conf)
    os.environ["PATH"] += ":/usr/sbin"
    start("slurmctld", "-D")
    start("slurmd", "-D")
    need("idle node", 60, lambda: "idle" in said("sinfo", "--noheader", "--format=%T"))


def submit(status=0):
    done = subprocess.run([options.limn, "bench", out / "suite.toml", "--out", out, "--slurm", "--nodes", "1", "--partition", "all"],
                          capture_output=True, text=True)
    check(done.returncode == status, f"submitting: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def measuring():
    """Processes of limn that measure a part."""
    found = said("pgrep", "-f", f"bench {out}/suite.toml --out {out}/parts").split()
    return [int(process) for process in found if pathlib.Path(f"/proc/{process}/exe").exists()
            and os.readlink(f"/proc/{process}/exe") == os.path.realpath(options.limn)]


def rows():
    return [json.loads(line) for line in (out / "results.jsonl").read_text().splitlines()]


try:
    start_cluster()
    out.mkdir()
    (out / "suite.toml").write_text(SUITE)
    print(submit().strip())
    check("is not finished" in submit(status=1), "a second job beside the first")
    wait_for("a task", 120, measuring)
    for process in measuring():
        os.kill(process, signal.SIGKILL)  # as a node that is lost, or a kernel out of memory
    wait_for("the end of all jobs", 900, lambda: not said("squeue", "--noheader").strip())
    check((out / "results.jsonl").is_file(), "nothing was merged")
    found = rows()
    check(len(found) == ROWS and len({row["key"] for row in found}) == ROWS, f"{len(found)} rows, wanted {ROWS}, each once")
    check(not any("failure" in row for row in found), "rows failed")
    check(all((out / row["reference"]["file"]).is_file() for row in found), "references are missing")
    check((out / "index.html").is_file() and (out / "tables.md").is_file(), "no report")
    check("rows are there" in submit(), "what is finished is submitted again")

    # What is lost afterwards is measured again, and only that.
    (out / "results.jsonl").write_text("".join(json.dumps(row) + "\n" for row in found[:-1]))
    for part in (out / "parts").iterdir():
        kept = [line for line in (part / "results.jsonl").read_text().splitlines() if json.loads(line)["key"] != found[-1]["key"]]
        (part / "results.jsonl").write_text("".join(line + "\n" for line in kept))
    check(submit().startswith("1 of 6 rows are missing"), "what is missing is not known")
    wait_for("the end of the second job", 300, lambda: not said("squeue", "--noheader").strip())
    check(sorted(row["key"] for row in rows()) == sorted(row["key"] for row in found), "a row is lost or doubled")
finally:
    for process in reversed(started):
        process.terminate()
        process.wait(20)
print(f"{ROWS} rows, each once, after a task was killed")
