#!/bin/sh
# The command line runs on servers without a display: fails if the program loads Qt Widgets, VTK or
# OpenCV highgui, itself or through another library.
# Usage: check_libraries.sh PROGRAM
set -eu
libraries=$(ldd "$1")
if printf '%s\n' "$libraries" | grep -E 'not found|not a dynamic executable|statically linked'; then
  echo "$1: its libraries cannot be listed"
  exit 1
fi
if printf '%s\n' "$libraries" | grep -E 'libQt[0-9]*Widgets|libvtk|libopencv_highgui'; then
  echo "$1: must not load the libraries above"
  exit 1
fi
