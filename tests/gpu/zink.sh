#!/bin/sh
# Runs a test program over Mesa's zink, OpenGL translated to Vulkan, on lavapipe, Vulkan on the processor: a second compiler and
# a second driver for everything that llvmpipe accepts. Usage: zink.sh LIMN PROGRAM [ARGUMENT...]. Exit status 77, skipped, where
# EGL does not offer it (Debian: mesa-vulkan-drivers).
limn=$1
shift
XDG_RUNTIME_DIR=$(mktemp -d) || exit 1
trap 'rm -rf "$XDG_RUNTIME_DIR"' EXIT
export XDG_RUNTIME_DIR GALLIUM_DRIVER=zink LIBGL_ALWAYS_SOFTWARE=1 LIMN_TEST_BACKEND=egl
if ! "$limn" render cornell_box --size 8x8 --repeat 1 --out "$XDG_RUNTIME_DIR/picture.png" 2>&1 | grep -q zink; then
  echo "skipped: EGL has no zink here; Debian's package is mesa-vulkan-drivers" >&2
  exit 77
fi
"$@"
