#!/bin/sh
# What is said of inputs that are likely to be meant otherwise.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

# Equal angles too few for the forward peak: said once, with what p then integrates to, and what helps.
one() { mie-phase --particle 1.33 --wavelength 550nm --radius 50um "$@"; }
bake() { printf '# radius:f64:um\tweight:f64:1\n50\t1\n' | txttab | medium-bake --xsect one.xsect --psd - --concentration 1e6/m3 --box 1m,1m,1m -o m "$@"; }
xsect --particle 1.33 --wavelength 550nm --radius 50um -o one.xsect
one --angles 181 -o coarse.tab 2>err
is '0 1' "$? $(grep -c '^mie-phase: --angles: 181 are too few for the forward peak of x = 571.2: .* about 4.66, not 1; take 2602 or more' err)" \
	'angles too few for the forward peak'
is 1 "$(wc -l <err)" 'are told in one line'
bake --phase coarse.tab 2>err
is '2 1' "$? $(grep -c 'is 4.67.., more than 1 % off 1: its angles are too few for its peaks (leave out --angles' err)" \
	'what refuses the table names the remedy; the integral was foretold'
one --angles 2602 -o fine.tab 2>err && bake --phase fine.tab 2>>err
is '0 ' "$? $(cat err)" 'as many as were asked for are taken, without a word'
one --angles 2601 -o near.tab 2>err
is 1 "$(wc -l <err)" 'one less is too few: 4.553 x + 1'
one -o own.tab 2>err && one --theta 0:180:1 -o some.tab 2>>err
is '' "$(cat err)" 'angles of their own are not too few, and given ones are what was asked for'
goa-phase --particle 1.33 --wavelength 550nm --radius 50um,1um --angles 181 -o goa.tab 2>err
is 1 "$(grep -c '^goa-phase: --angles: 181 are too few for the forward peak of x = 571.2:' err)" 'goa-phase: the largest counts'
# A mean: weighted as what is scattered, a few large ones do not count.
printf '# radius:f64:um\tweight:f64:1\n1\t1\n50\t1e-9\n' | txttab >few.tab
printf '# radius:f64:um\tweight:f64:1\n1\t1\n50\t1e-2\n' | txttab >many.tab
mean() { mie-phase --particle 1.33 --wavelength 550nm --average --angles 1001 "$1" -o mean.tab 2>err; wc -l <err; }
is '0 1' "$(mean few.tab) $(mean many.tab)" 'in a mean'

# A scene's error names its key.
printf '# x:f32:m\ty:f32:m\tz:f32:m\tradius:f64:um\n0\t0\t0\t500\n1e-4\t0\t0\t500\n0.01\t0\t0\t500\n' | txttab >grains.tab
mie-phase --particle 1.33 --wavelength 550nm --radius 500um --theta 0:180:0.01 | tabtxt --columns wavelength,theta,p | sed 's/[^	]*$/0.07957747154594767/; 1s/0.079.*/p:f64:sr^-1/' |
	txttab >even.tab
xsect --particle 1.33 --wavelength 550nm --radius 500um | medium-bake --xsect - --phase even.tab --box 2cm,2cm,2cm -o grains.medium grains.tab
camera='camera = { position = [0.0, 0.0, 3.0]; target = [0.5, 0.0, 0.0]; fov = 34.0; resolution = [6, 4]; };'
medium='medium = { file = "grains.medium"; };'
wrong() { printf '%s\n' "$2" "$3" "$4" >wrong.scene; refused "$1" "^vrender: wrong.scene: line $5" vrender --samples 1 -o no.exr wrong.scene; }
while IFS='|' read -r group value message; do
	camera_is=$camera medium_is=$medium rest=
	case $group in camera) camera_is=$value ;; medium) medium_is=$value ;; *) rest=$value ;; esac
	wrong "$value" "$camera_is" "$medium_is" "$rest" "$message"
done <<'END'
camera|camera = { position = [0.0, 0.0, 3.0]; target = [0.0, 0.0, 0.0]; fov = "wide"; resolution = [6, 4]; };|1: camera.fov must be a number
camera|camera = { position = [0.0, 0.0, 3.0]; target = [0.0, 0.0]; fov = 30; resolution = [6, 4]; };|1: camera.target must be 3 numbers
camera|camera = { position = [0.0, 0.0, 1e10]; target = [0.0, 0.0, 0.0]; fov = 30; resolution = [6, 4]; };|1: camera.position 1e\+10 is out of range
camera|camera = { position = [0.0, 0.0, 3.0]; target = [0.0, 0.0, 0.0]; fov = 200; resolution = [6, 4]; };|1: camera.fov 200 is out of range
camera|camera = 3;|1: camera must be one group
medium|medium = ( { file = "grains.medium"; }, { file = "grains.medium"; } );|2: medium must be one group \{ .. \}; several are media = \(
medium|medium = 3;|2: medium must be one group \{ .. \} \(known there: file position transport\)
medium|medium = { file = 3; };|2: medium.file must be a string
medium|medium = { };|2: medium needs a key 'file'
lights|lights = ( { type = "sun"; direction = [0, -1, 0]; irradiance = 1; }, { type = "sun"; direction = [0, -1, 0]; irradiance = "x"; } );|3: lights\[1\].irradiance must be a number
lights|lights = ( { type = "sun"; direction = ( 0, -1, "down" ); irradiance = 1; } );|3: lights\[0\].direction\[2\] must be a number
lights|lights = ( 3 );|3: lights\[0\] must be a group
lights|lights = ( { type = "lamp"; } );|3: lights\[0\].type must be
END

# A camera inside a grain.
see() { printf '%s\n' "camera = { position = [$1]; target = [0.5, 0.0, 0.0]; fov = 34.0; resolution = [6, 4]; };" "$medium" >in.scene
	shift; vrender --samples 1 "$@" -o in.exr in.scene 2>err; }
see '0.0101, 0.0, 0.0'
is 'vrender: in.scene: camera.position is inside a particle of radius 500 um at [0.01, 0, 0], which is not seen as from inside' "$(cat err)" \
	'a camera in a particle is told which'
see '0.0, 0.0, 1e-4' --transport fat-ray
is 1 "$(grep -c 'inside 2 particles, one of them of radius 500 um at' err)" 'or in how many'
see '0.0, 0.0, 0.0006' && [ ! -s err ] && see '0.0, 0.0, 1e-4' --transport grid
is '' "$(cat err)" 'outside, and where particles are not seen, nothing is told'

# Tables that do not belong together.
a='lognormal --median 5um --gsd 1.3'
b='lognormal --gsd 1.3 --median 5.2um'
# shellcheck disable=SC2086
{ psd $a -o a.psd; psd $a --classes 7 -o a7.psd; psd $b -o b.psd; psd lognormal --gsd 1.3 --median 5000nm -o a.nm.psd; }
for x in a b a.nm; do
	xsect --particle water --wavelength 550nm $x.psd -o $x.xsect
	mie-phase --particle water --wavelength 550nm --average $x.psd -o $x.phase
	particles --psd $x.psd --count 100 --box 1cm,1cm,1cm -o $x.grains
done
mie-phase --particle water --wavelength 550nm a.psd -o a.phases
xsect --particle ice --wavelength 550nm a.psd -o ice.xsect
goa-phase --host 1.0 --particle water --wavelength 550nm --average a.psd -o goa.phase
tabtxt --columns radius,weight a.psd | txttab -o own.psd
tabtxt --columns wavelength,theta,p b.phase | txttab -o own.phase
baked() { medium-bake -o baked.medium "$@" 2>err; echo "$? $(cat err)"; }    # its status and what it said
fog() { baked --concentration 1/cm3 --box 1cm,1cm,1cm "$@"; }
refused 'cross sections of another distribution' '^medium-bake: b.xsect: is of other radii than --psd, and not made from it \(psd --gsd 1.3 --median 5um lognormal\)' \
	medium-bake --psd a.psd --xsect b.xsect --phase a.phase --concentration 1/cm3 --box 1cm,1cm,1cm -o no.medium
is '0 medium-bake: b.phase: is of another size distribution than what is baked, it seems (psd --gsd 1.3 --median 5um lognormal)' \
	"$(fog --psd a.psd --xsect a.xsect --phase b.phase)" 'a mean phase function of another: a warning, for it has no radii'
is '0 medium-bake: b.xsect: is of another size distribution than the particles, it seems (psd --gsd 1.3 --median 5um lognormal)' \
	"$(baked --xsect b.xsect --phase b.phase a.grains)" 'particles of another: likewise, and once'
is '0 medium-bake: a.phase: is of other particles than the cross sections, it seems (--particle ice)' \
	"$(fog --psd a.psd --xsect ice.xsect --phase a.phase)" 'ice and water'
while read -r sizes cross phase; do
	is '0 ' "$(fog --psd "$sizes.psd" --xsect "$cross.xsect" --phase "$phase")" "nothing against $sizes, $cross, $phase"
done <<'END'
a a a.phase
a a a.phases
a a goa.phase
a.nm a a.phase
a a own.phase
own a a.phase
own b b.phase
a7 a a.phase
END
is '0 ' "$(baked --xsect a.xsect --phase a.phase a.grains)" 'nothing against particles'
# Two kinds of particles, as tabcat joins them.
tabcat a.grains b.grains -o both.grains
tabcat a.xsect b.xsect -o both.xsect
is '0 ' "$(baked --xsect both.xsect --phase own.phase both.grains)" 'nor two kinds of them'
is '0 ' "$(baked --xsect both.xsect --phase own.phase a.grains)" 'nor one of the two'
done_testing
