#!/bin/sh
# What is between the particles absorbs: as much as particles that absorbed so would.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/render.sh
. "$top/tests/support/render.sh"

# A host of absorption 4 pi k / wavelength beside particles of extinction 2 that do not absorb, and particles alone that do both.
k=4e-8
rows() {     # rows HOST: 1 to have its absorption in the particles
	awk -v k=$k -v own="$1" 'BEGIN {
		print "# wavelength:f64:um\tradius:f64:um\tc_ext:f64:um^2\tc_sca:f64:um^2"
		pi = atan2(0, -1)
		for (w = 0.45; w < 0.7; w += 0.1) printf "%g\t1000\t%.12g\t%.12g\n", w, 2e6 + own * 4 * pi * k / (w * 1e-6) * 1e6, 2e6 }' | txttab
}
rows 0 >clear.xsect
rows 1 >dark.xsect
one_size
hg 0.9 0.45 0.55 0.65 >9.phase
bake() { name=$2.medium from=$1.xsect; shift 2; medium-bake --xsect "$from" --phase 9.phase --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m -o "$name" "$@"; }
bake clear hosted --host "1.33+${k}i"
bake dark alone
bake clear clear --host 1.33
tr '\n' ' ' <hosted.medium | grep -aq 'host	1.117' && ! tr '\n' ' ' <clear.medium | grep -aq ' host	'
ok $? 'the file says what the host absorbs, if anything'
# a small sun, of which the forward peak would make spikes: the chains that avoid them pass the host, too
for name in hosted alone; do
	cat >$name.scene <<-EOT
	camera = { position = [3.2, 2.4, 4.2]; target = [0.0, 0.0, 0.0]; fov = 18.0; resolution = [64, 64]; };
	medium = { file = "$name.medium"; };
	lights = ( { type = "environment"; radiance = 0.2; }, { type = "sun"; direction = [-0.6, -1.0, -0.3]; irradiance = 3.0; angle = 0.5; } );
	EOT
done
twice hosted hosted.scene 1 --samples 128
twice alone alone.scene 3 --samples 128
same_picture alone hosted
for i in 1 2; do
	channels mean hosted.$i.exr AB
	channels mean alone.$i.exr AB
done | awk '{ v[NR] = $1 } END { d = (v[1] + v[3] - v[2] - v[4]) / 2; print d; exit !(d < 3e-3 && d > -3e-3 && v[1] > 0.9) }' >told
ok $? "and what is behind is hidden as much: $(cat told)"
channels rms hosted.1.exr G - hosted.2.exr G >one
channels rms alone.1.exr G - alone.2.exr G >other
paste one other | awk '{ exit !($1 < 2 * $2) }'
ok $? "with less noise than spikes, or absorption by chance, would make: $(paste one other)"

every_way host hosted.scene 3

# ---- by default it is the host of the cross sections
sizes 1 | tabtxt | sed 's/^1000/100/' | txttab >bubbles.psd
hg 0.5 >5.phase
xsect --particle 1 --host 1.33+${k}i --wavelength 550nm --method mie bubbles.psd -o bubbles.xsect
bubbles() { medium-bake --xsect bubbles.xsect --phase 5.phase --psd bubbles.psd --concentration 1e6/m3 --box 1m,1m,1m "$@" -o bubbles.medium; }
bubbles && tr '\n' ' ' <bubbles.medium | grep -aq ' host	0.9139'
ok $? 'the host of the cross sections'
bubbles --host 1 && ! tr '\n' ' ' <bubbles.medium | grep -aq ' host	'
ok $? 'unless told otherwise'
bubbles --host water && tr '\n' ' ' <bubbles.medium | grep -aq ' host	0.0'
ok $? 'a material'
for wrong in soup 1.33-0.1i 0; do
	bubbles --host $wrong 2>err
	[ $? -eq 2 ] && [ "$(wc -l <err)" -eq 1 ] && grep -q -- "--host: '$wrong'" err
	ok $? "refused: $(cat err)"
done
# as many media as there may be, and a host more
cat >many.scene <<-EOT
camera = { position = [3.2, 2.4, 4.2]; target = [0.0, 0.0, 0.0]; fov = 18.0; resolution = [4, 4]; };
media = ( $(for i in 1 2 3 4 5 6 7; do printf '{ file = "clear.medium"; }, '; done) { file = "hosted.medium"; } );
EOT
vrender many.scene --samples 1 -o many.exr 2>err
[ $? -eq 2 ] && [ "$(wc -l <err)" -eq 1 ] && grep -q 'more than 8 media' err
ok $? "refused: $(cat err)"
done_testing
