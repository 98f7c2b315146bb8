"""Installs limn once for the tests beside this one. The prefix is moved: nothing in it may name where it was."""
import shutil

from common import PREFIX, SCRATCH, check, options, run, techniques

shutil.rmtree(SCRATCH, ignore_errors=True)
run("cmake", "--install", options.build, "--prefix", SCRATCH / "prefix")
(SCRATCH / "prefix").rename(PREFIX)
check(techniques(), "the installed limn lists no technique")
