#!/bin/sh
# Reads the sources under ROOT and fails on what the house rules forbid; prints each place.
#   arrows   app -> ui -> measurement -> reconstruction, and the finer order below
#   headers  no heavy library in a header of ours: each includer would pay seconds for it
#   readmes  every README.md in a folder has at most 40 lines
#   paths    no path of a developer's machine
# Usage: check_tree.sh ROOT
set -eu
cd "$1"

sources() {
  find app ui measurement reconstruction tests \( -name '*.h' -o -name '*.cpp' \) 2>/dev/null | sort
}

# A file may include from folders of its own rank or below. Tests may include everything.
check_includes() {
  sources | while read -r file; do
    awk -v file="$file" '
      BEGIN {
        count = split("reconstruction/base reconstruction/scene reconstruction/capture " \
          "reconstruction/fusion reconstruction/texture reconstruction/pipeline " \
          "measurement/outline measurement/wound measurement/scores measurement/phantom measurement/comparison measurement/records measurement/report ui app tests", \
          folders, " ")
        own = rank(file)
        if (own == 0) print file ": its folder has no place in the order of check_tree.sh"
      }
      function rank(path,   i) {
        for (i = 1; i <= count; i++)
          if (index(path, folders[i] "/") == 1) return i
        return 0
      }
      /^[ \t]*#[ \t]*include[ \t]*"/ {
        split($0, part, "\"")
        if (rank(part[2]) == 0)
          print file ":" FNR ": \"" part[2] "\" is not written from the repository root"
        else if (rank(part[2]) > own)
          print file ":" FNR ": includes " part[2] " against the arrows"
      }
      file ~ /\.h$/ && /^[ \t]*#[ \t]*include[ \t]*[<"](CGAL|pcl|OpenMesh|ceres|vtk|opencv2|OpenNI|embree|open3d)/ {
        print file ":" FNR ": heavy library in a header: " $0
      }
    ' "$file"
  done
}

check_readmes() {
  find . -mindepth 2 -name README.md -not -path './build/*' -not -path './.git/*' |
    while read -r file; do
      lines=$(wc -l <"$file")
      if [ "$lines" -gt 40 ]; then echo "$file: $lines lines, 40 are allowed"; fi
    done
}

check_paths() {
  find . -type f -not -path './build/*' -not -path './.git/*' -not -path './demo/*' \
       -exec grep -IHnE '(^|[^[:alnum:]_.-])/(home|Users|work|root)/[[:alnum:]]' {} + || true
}

found=$(check_includes; check_readmes; check_paths)
if [ -n "$found" ]; then
  printf '%s\n' "$found"
  exit 1
fi
