#!/bin/sh
# A density of each class: the drops, and so the phase function and the colour, differ from place to place.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/render.sh
. "$top/tests/support/render.sh"

# ---- an effective radius of 4 to 20 um, 64^3 cells, against a program of the tests' own: all that the image sees, by wavelength
cell_paths field >field.npy
cell_paths xsect | txttab -o field.xsect
cell_paths phase | txttab -o field.phase
awk 'BEGIN { print "# radius:f64:um\tweight:f64:1"; for (r = 4; r <= 20; r += 4) printf "%d\t0.2\n", r }' | txttab -o field.psd
medium-bake --xsect field.xsect --phase field.phase --psd field.psd --concentration 5e6/m3 --box 2m,2m,2m --density field.npy -o field.medium
# 1.5 m at a distance of 10 km
cat >field.scene <<-'EOT'
camera = { position = [0.0, 0.0, 10000.0]; target = [0.0, 0.0, 0.0]; fov = 0.008594366926962348; resolution = [32, 32]; };
medium = { file = "field.medium"; };
lights = ( { type = "sun"; direction = [0.0, -1.0, -0.5]; irradiance = 3.14159265358979; angle = 180.0; } );
EOT
twice field field.scene 1 --samples 256
cell_paths mean 400000 1 >brute
# 2 x 256 samples of 1024 pixels, and 4e5 paths: standard errors of 1e-3 and less of 0.4; |z| of 3 channels above 4 is chance for 2 in 10^4
for c in 'B 1' 'G 2' 'R 3'; do
	blocks field "${c% *}" >field.blocks
	awk '{ m += $1; v += $2 } END { printf "%.6f %.2g\n", m / NR, sqrt(v) / NR }' field.blocks >mean
	sed -n "${c#* }p" brute | paste mean - | awk '{ z = ($1 - $3) / sqrt($2 * $2 + $4 * $4); print $0, z; exit !(z < 4 && z > -4 && $3 > 0.1) }' >told
	ok $? "cells of different drops, ${c% *}: $(cat told)"
done

# ---- the same bytes from every way to run it
every_way classes field.scene 3
sed 's/\[32, 32\]/[4, 3]/' field.scene >tiny.scene
simulated 'densities of classes' tiny.scene

# ---- two classes in one medium are two media of one class in one place
field() {     # field EXPRESSION: of cell x, y, z of 6^3, little-endian floats
	perl -e 'my $e = shift; for my $z (0 .. 5) { for my $y (0 .. 5) { for my $x (0 .. 5) { print pack "f<", eval $e } } }' "$1"
}
npy() {
	perl -e 'my $h = "{\x27descr\x27: \x27<f4\x27, \x27fortran_order\x27: False, \x27shape\x27: ($ARGV[0]), }";
		$h .= " " x ((64 - (11 + length $h) % 64) % 64) . "\n"; print "\x93NUMPY\x01\x00", pack("v", length $h), $h' "$1"
}
# shellcheck disable=SC2016 # the variables are those of Perl
field '$x * $y / 5' >first.f4
# shellcheck disable=SC2016
field '$z > 2 ? 3 - $x / 3 : 0' >second.f4
{ npy '6, 6, 6'; cat first.f4; } >first.npy
{ npy '6, 6, 6'; cat second.f4; } >second.npy
{ npy '2, 6, 6, 6'; cat first.f4 second.f4; } >both.npy
{
	printf '# wavelength:f64:um\tradius:f64:um\ttheta:f64:deg\tp:f64:sr^-1\n'
	hg_rows 0.2 1000 0.45 0.55 0.65
	hg_rows 0.8 2000 0.45 0.55 0.65
} | txttab >both.phase
hg 0.2 0.45 0.55 0.65 >first.phase
hg 0.8 0.45 0.55 0.65 >second.phase
# xs FILE 'RADIUS C_EXT'..: at three wavelengths, of which the second has C_EXT; the first class is the redder
xs() {
	out=$1
	shift
	for one; do echo "$one"; done | awk '{ slope = $1 == 1000 ? 0.5 : -0.5
		for (w = -1; w <= 1; w++) printf "%g\t%d\t%.10g\t%.10g\n", 0.55 + 0.1 * w, $1, $2 * (1 + slope * w), 0.9 * $2 * (1 + slope * w) }' |
		{ printf '# wavelength:f64:um\tradius:f64:um\tc_ext:f64:um^2\tc_sca:f64:um^2\n'; cat; } | txttab >"$out"
}
xs both.xsect '1000 1e6' '2000 2e6'
xs first.xsect '1000 1e6'
xs second.xsect '2000 2e6'
sizes 2 >two.psd
printf '# radius:f64:um\tweight:f64:1\n2000\t1\n' | txttab >second.psd
one_size
bake() { medium-bake --box 2m,2m,2m "$@"; }
bake --xsect both.xsect --phase both.phase --psd two.psd --concentration 1e6/m3 --density both.npy -o both.medium
bake --xsect first.xsect --phase first.phase --psd one.psd --concentration 5e5/m3 --density first.npy -o first.medium
bake --xsect second.xsect --phase second.phase --psd second.psd --concentration 5e5/m3 --density second.npy -o second.medium
head='camera = { position = [3.2, 2.4, 4.2]; target = [0.0, 0.0, 0.0]; fov = 18.0; resolution = [64, 64]; };
lights = ( { type = "environment"; radiance = 0.2; }, { type = "sun"; direction = [-0.6, -1.0, -0.3]; irradiance = 3.0; angle = 20.0; } );'
printf '%s\nmedium = { file = "both.medium"; };\n' "$head" >both.scene
printf '%s\nmedia = ( { file = "first.medium"; transport = "grid"; }, { file = "second.medium"; } );\n' "$head" >apart.scene
twice both both.scene 5 --samples 128
twice apart apart.scene 7 --samples 128
same_picture apart both
bake --xsect both.xsect --phase both.phase --psd two.psd --concentration 1e6/m3 --density both.npy --tolerance 1e-3 -o thin.medium
sed 's/both/thin/' both.scene >thin.scene
twice thin thin.scene 9 --samples 128
same_picture both thin

# ---- what does not belong together
bake --xsect first.xsect --phase first.phase --psd one.psd --concentration 1/m3 --density both.npy -o no.medium 2>err
[ $? -eq 2 ] && [ "$(wc -l <err)" -eq 1 ] && grep -q 'both.npy: has densities of 2 classes, and --xsect 1 radii' err
ok $? "refused: $(cat err)"
particles --psd two.psd --count 3 --box 1m,1m,1m --density both.npy >none 2>err
[ $? -eq 2 ] && [ "$(wc -l <err)" -eq 1 ]
ok $? "refused: $(cat err)"
done_testing
