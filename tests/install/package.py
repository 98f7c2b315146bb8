"""The Debian package: it installs into an empty system, runs there with this system's libraries, and leaves nothing behind."""
import os
import shutil
import subprocess
import sys

from common import SCRATCH, check, fresh, limn, options, run, techniques

SKIPPED = 77
for tool in ("cpack", "dpkg-shlibdeps", "dpkg", "file"):
    if shutil.which(tool) is None:
        print(f"skipped: no {tool} (Debian packages cmake, dpkg-dev, file)")
        sys.exit(SKIPPED)
if os.geteuid() != 0:
    print("skipped: dpkg installs as root only")
    sys.exit(SKIPPED)

out = fresh("package")
# Compressed as dpkg takes it, too, in a tenth of the time.
run("cpack", "-G", "DEB", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip", "-B", out, cwd=options.build)
(package,) = out.glob("*.deb")
field = lambda name: run("dpkg-deb", "-f", package, name)[0].strip()
check(field("Package") == "limn" and field("Version"), "the package has no name or no version")
wanted = [entry.split("|")[0].split("(")[0].strip() for entry in field("Depends").split(",")]
check("libegl1" in wanted and any(name.startswith("libopenimageio") for name in wanted), f"it depends on {wanted}")
for name in wanted:
    status = subprocess.run(["dpkg-query", "-W", "-f=${Status}", name], capture_output=True, text=True).stdout
    check("ok installed" in status, f"it depends on {name}, which limn was built without")

system = out / "system"
(system / "var/lib/dpkg/updates").mkdir(parents=True)
(system / "var/lib/dpkg/info").mkdir()
(system / "var/lib/dpkg/status").touch()


def files():
    return sorted(path.relative_to(system) for path in system.rglob("*") if not path.is_relative_to(system / "var"))


# The script that tells the linker of new libraries has no shell in there: it runs outside.
dpkg = ("dpkg", f"--root={system}", "--force-depends", "--force-script-chrootless", "--no-triggers")
run(*dpkg, "-i", package)
prefix = system / "usr"
check(len(techniques(prefix)) > 20, "the installed limn lists few techniques")
limn("render", "balls", "--technique", "vssm", "--size", "32x24", "--out", out / "balls.png", prefix=prefix)
check((out / "balls.png").read_bytes().startswith(b"\x89PNG"), "no picture")
check((prefix / "share/doc/limn/copyright").is_file(), "no licence")
for file in files():
    mode = (system / file).lstat().st_mode
    check(not mode & 0o002 or (system / file).is_symlink(), f"everybody may write {file}")
run(*dpkg, "--purge", "limn")
check(not files(), f"it leaves {files()[:5]}")
print(f"{package.name}: {package.stat().st_size / 2 ** 20:.1f} MiB, depends on {len(wanted)} packages")
