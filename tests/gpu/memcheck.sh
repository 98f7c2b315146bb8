#!/bin/sh
# Runs valgrind with the arguments given. Exit status 77, skipped, on a processor without RDTSCP: valgrind tells programs
# that they have this instruction and then refuses it, and Highway (under OpenImageIO) uses it as it is loaded.
if ! grep -qw rdtscp /proc/cpuinfo; then
  echo "skipped: valgrind refuses RDTSCP where the processor lacks it" >&2
  exit 77
fi
exec valgrind "$@"
