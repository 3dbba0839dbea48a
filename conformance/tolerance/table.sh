#!/bin/sh
# Prints the lines of thresholds.csv: `sh conformance/tolerance/table.sh build/ted4tolerance
# [ID...]`; without ids, for the vectors of the folders below.
export LC_ALL=C
program=$(realpath "$1")
shift
echo 'vector,query,records,position_peak,position_rms,scale_peak,scale_rms,rotation_peak,rotation_rms,opacity_peak,opacity_rms,colour_peak,colour_rms'
cd conformance/vectors || exit 1
find content worked valid/time valid/view -name '*.json' | sort | while read -r f; do
    grep -q '"result":"valid"' "$f" && grep -q '"queries":\[{' "$f" || continue
    id=$(basename "$f" .json)
    [ $# -eq 0 ] || case " $* " in *" $id "*) ;; *) continue ;; esac
    [ -f "${f%.json}.ted4" ] || continue
    "$program" table "$f" || exit 1
done
