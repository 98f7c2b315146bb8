"""Runs one libFuzzer target for a while on a new corpus. What it finds stays as a file beside the corpus."""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys

import model_seeds

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("fuzzer")
parser.add_argument("--seconds", type=int, required=True)
parser.add_argument("--corpus", type=pathlib.Path, required=True)
parser.add_argument("--models", type=pathlib.Path, help="folder of .glb files cut to seeds; those of LIMN_MODELS, too")
parser.add_argument("--longest", type=int, default=4096, help="bytes of an input")
parser.add_argument("--seeds", nargs=argparse.REMAINDER, required=True, help="command; the folder is appended")
arguments = parser.parse_args()

shutil.rmtree(arguments.corpus, ignore_errors=True)
arguments.corpus.mkdir(parents=True)
subprocess.run([*arguments.seeds, arguments.corpus], check=True)
if arguments.models:
    model_seeds.main(arguments.corpus, arguments.models, *filter(None, [os.environ.get("LIMN_MODELS")]))
# Stacks of allocations are not recorded and little freed memory is kept aside: half of the time otherwise. A finding is
# looked at with the defaults.
os.environ.setdefault("ASAN_OPTIONS", "malloc_context_size=0:quarantine_size_mb=4:thread_local_quarantine_size_kb=64:"
                                      "allocator_release_to_os_interval_ms=-1")
found = arguments.corpus.with_name(arguments.corpus.name + "-found-")
sys.exit(subprocess.run([
    arguments.fuzzer, f"-max_total_time={arguments.seconds}", f"-max_len={arguments.longest}", "-entropic=0", "-timeout=20", "-rss_limit_mb=2048",
    "-seed=1", "-verbosity=0", "-print_final_stats=1", f"-artifact_prefix={found}", arguments.corpus,
]).returncode)
