"""Runs one libFuzzer target for a while on a corpus made anew. What it finds stays as a file beside the corpus."""

import argparse
import pathlib
import shutil
import subprocess
import sys

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("fuzzer")
parser.add_argument("--seconds", type=int, required=True)
parser.add_argument("--corpus", type=pathlib.Path, required=True)
parser.add_argument("--seeds", nargs=argparse.REMAINDER, required=True, help="command; the folder is appended")
arguments = parser.parse_args()

shutil.rmtree(arguments.corpus, ignore_errors=True)
arguments.corpus.mkdir(parents=True)
subprocess.run([*arguments.seeds, arguments.corpus], check=True)
found = arguments.corpus.with_name(arguments.corpus.name + "-found-")
sys.exit(subprocess.run([
    arguments.fuzzer, f"-max_total_time={arguments.seconds}", "-max_len=4096", "-timeout=20", "-rss_limit_mb=2048",
    "-seed=1", "-verbosity=0", "-print_final_stats=1", f"-artifact_prefix={found}", arguments.corpus,
]).returncode)
