# SPDX-License-Identifier: MIT
# Octave reads what the programs write, where it is installed: a trajectory.csv, and the NetCDF file of a sweep where Octave
# has its package netcdf. Arguments: the command moray, the source directory.
. "$2/tests/program.sh"
if ! command -v octave-cli >/dev/null; then
    echo "1..0 # SKIP no octave (Debian's octave; octave-netcdf for the files of sweeps)"
    exit 0
fi

# reads TEXT: what Octave prints, into `read`.
reads() { octave-cli --norc --no-history --quiet --eval "$1" >read 2>complaints </dev/null; }

run simulate --links 5 --duration 3 --quiet --out swum
check "swum: $(cat err)" [ $code -eq 0 ]
check "Octave reads the CSV: $(reads 'd = importdata("swum/trajectory.csv", ",", 1); disp(d.colheaders{1}); printf("%d\n", size(d.data)); printf("%.17g\n", d.data(end, :))'; head -1 complaints)" [ -s read ]
{
    head -n 1 swum/trajectory.csv | sed 's/,.*//; s/"//g'
    awk 'END { print NR - 1 }' swum/trajectory.csv
    awk -F, 'NR == 1 { print NF }' swum/trajectory.csv
    tail -n 1 swum/trajectory.csv | tr ',' '\n'
} >written
# same: names and numbers, these to their last digit but one.
same() {
    paste -d '|' read written | awk -F '|' '$1 == $2 { next } $1 + 0 == 0 && $2 + 0 == 0 && $1 !~ /[1-9a-z]/ { next }
        { d = $1 - $2; s = $1 < 0 ? -$1 : $1; if (d < 0) d = -d; if (!(d <= 1e-15 * s)) exit 1 }'
}
check "as it was written: $(wc -l <written) of $(wc -l <read) lines" eval '[ "$(wc -l <read)" -eq "$(wc -l <written)" ] && same'

run sweep simulate --grid links=4,6 --grid current_x=-0.1:0.1:3 --file links.nc --quiet -- --duration 1
check "swept: $(cat err)" [ $code -eq 0 ]
if reads 'pkg load netcdf'; then
    reads 'pkg load netcdf; printf("%.17g\n", ncread("links.nc", "simulated_speed_m_s"))'
    ncdump -p 17,17 -v simulated_speed_m_s links.nc | sed -n '/^ simulated_speed_m_s =/,/;/p' | sed 's/.*=//' | tr -d ' ;' | tr ',' '\n' | sed '/^$/d' >written
    check "Octave reads the NetCDF file: $(wc -l <written) numbers: $(head -1 complaints)" eval '[ "$(wc -l <written)" -eq 6 ] && [ "$(wc -l <read)" -eq 6 ] && same'
else
    echo "ok $((tap_run += 1)) - Octave reads the NetCDF file # SKIP no package netcdf (Debian's octave-netcdf)"
fi
tap_done
