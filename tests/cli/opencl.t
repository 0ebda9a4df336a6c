#!/bin/sh
# The OpenCL backend's host: which device, its launches, the cache of built programs, and one line for what goes wrong.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/render.sh
. "$top/tests/support/render.sh"
hg 0.8 0.45 0.55 0.65 >hg3.phase
dispersed 90000000 0.97 0.45 0.55 0.65 >three.xsect
grains three.medium 3000 three.xsect hg3.phase
oiiotool --pattern noise:type=uniform:min=0:max=2 64x32 3 -d float -o sky.exr
scene three.scene three.medium 48 'lights = ( { type = "environment"; file = "sky.exr"; }, { type = "sun"; direction = [-0.6, -1.0, -0.3]; irradiance = 2.0; } );'
cl() { vrender three.scene --backend opencl --samples 24 "$@"; }
vrender three.scene --samples 24 -o c.exr

# ---- devices

vrender --list-devices >list
ok $? 'the devices are listed'
is '' "$(awk -F'\t' 'NF != 5 || $1 != NR - 1 || $2 == "" || $3 !~ /^(CPU|GPU|accelerator)$/ || $4 == "" || $5 !~ /^[0-9.]+ GiB$/' list)" \
	'a line each: number, name, kind, platform, memory'
export POCL_DEVICES='pthread basic'
is 2 "$(vrender --list-devices | grep -c 'CPU.*Portable Computing Language')" 'two drivers for the same processors'
for i in 0 1; do
	cl --device $i -o cl.exr && cmp c.exr cl.exr
	ok $? "device $i gives the bytes of C"
done
cl --verbose -o cl.exr 2>err && grep -q '^vrender: OpenCL: device 0: .*, CPU, ' err
ok $? 'without a GPU the first device is the default'
unset POCL_DEVICES
# a simulator that says it is a GPU, behind PoCL; it need not get far
simulator=$(dirname "$(command -v oclgrind)")/../lib/oclgrind/liboclgrind-rt-icd.so
mkdir vendors
echo libpocl.so.2 >vendors/a.icd
echo "$simulator" >vendors/b.icd
OCL_ICD_VENDORS=$tmp/vendors vrender --list-devices >list
gpu=$(awk -F'\t' '$3 == "GPU" { print $1; exit }' list)
OCL_ICD_VENDORS=$tmp/vendors vrender three.scene --backend opencl --samples 1 --verbose -o gpu.exr 2>err
grep -q "^vrender: OpenCL: device ${gpu:-none}: .*, GPU, " err
ok $? 'with one, the GPU is'
refused 'a device that is not there' '^vrender: --device: 60 is none of the' cl --device 60 -o no.exr
refused 'a device for the C backend' '^vrender: --device: goes with --backend opencl' vrender three.scene --device 0 -o no.exr

# ---- what can go wrong

mkdir empty
refused 'no platform' '^vrender: OpenCL: no platform' env OCL_ICD_VENDORS="$tmp/empty" "$MOTES_BUILD/bin/vrender" three.scene --backend opencl -o no.exr
refused 'no platform to list' '^vrender: OpenCL: no platform' env OCL_ICD_VENDORS="$tmp/empty" "$MOTES_BUILD/bin/vrender" --list-devices
POCL_DEVICES=none refused 'no device' '^vrender: OpenCL: no device' cl -o no.exr
POCL_EXTRA_BUILD_FLAGS=-DFN=bogus refused 'kernels that do not compile' '^vrender: OpenCL: the kernels do not build .*bogus' cl -o no.exr
POCL_EXTRA_BUILD_FLAGS=-bogus refused 'an option that the compiler does not know' '^vrender: OpenCL: the kernels do not build .*-bogus' cl -o no.exr
scene huge.scene three.medium 3300 ''     # 18 sums of 8 bytes a pixel
POCL_MEMORY_LIMIT=1 refused 'a film larger than the device' '^vrender: OpenCL: out of memory on the device: .* 1.5 GiB' \
	vrender huge.scene --backend opencl -o no.exr
for limit in 100 4000; do
	MOTES_CL_BUFFER=$limit refused "a table larger than buffers of $limit bytes" '^vrender: OpenCL: out of memory on the device' cl -o no.exr
done
MOTES_CL_BUFFER=much refused 'a limit that is none' "^vrender: MOTES_CL_BUFFER: 'much'" cl -o no.exr
is '' "$(ls no.exr* 2>/dev/null)" 'no image appears under its name'

# ---- launches: any part of the film and of the samples gives the same

for limit in 100KiB 64KiB; do     # the film has 252 KiB, the largest table 299
	MOTES_CL_BUFFER=$limit cl -o cl.exr && cmp c.exr cl.exr
	ok $? "a film in buffers of $limit"
done
cl --spectral -o cl.exr && vrender three.scene --samples 24 --spectral -o spectral.exr && cmp spectral.exr cl.exr
ok $? 'a spectral film'
for t in explicit grid; do
	vrender three.scene --transport $t --samples 24 -o c$t.exr
	MOTES_CL_BUFFER=64KiB cl --transport $t -o cl.exr && cmp c$t.exr cl.exr
	ok $? "$t: tables in several buffers"
done
scene long.scene three.medium 64 ''
for b in c opencl; do
	# env, for a test that runs in the background is born deaf to it; a render that did not end is killed, which is 137
	timeout --preserve-status -s INT -k 5 2 env --default-signal=INT vrender long.scene --samples 1e8 --backend $b -o long.exr 2>err
	is "130 long.scene" "$? $(echo long.*)$(cat err)" "$b: Ctrl-C ends it by the signal, and leaves nothing"
	timeout --preserve-status -s TERM -k 5 1 vrender long.scene --samples 1e8 --backend $b -o long.exr 2>err
	is "143 long.scene" "$? $(echo long.*)$(cat err)" "$b: so does SIGTERM"
done

# ---- the cache. PoCL has one of its own, new where a start is to show whether the compiler ran: it then fails.

export XDG_CACHE_HOME="$tmp/cache"
unused() { rm -rf "$tmp/pocl2" && mkdir "$tmp/pocl2" && POCL_CACHE_DIR=$tmp/pocl2 POCL_EXTRA_BUILD_FLAGS=-DFN=bogus "$@"; }
same() { [ "$(cat err)" = '' ] && cmp c.exr cl.exr; }
cl -o cl.exr 2>err && same
ok $? 'a program that is built anew'
is 1 "$(find cache -type f | wc -l)" 'it is kept'
kept=$(echo cache/motes/*)
cp -p "$kept" good
before=$(stat -c '%i %Y' "$kept")
unused cl -o cl.exr 2>err && same
ok $? 'the next start needs no compiler, and gives the same bytes'
is "$before" "$(stat -c '%i %Y' "$kept")" 'it leaves the file as it is'
refused 'another program is not in it' 'do not build' unused cl --transport grid -o no.exr
# damaged NAME COMMAND..: what the command leaves in $kept is of no use, is replaced, and nobody notices
damaged() {
	label=$1
	shift
	"$@"
	refused "$label: not used" 'do not build' unused cl -o no.exr
	rm -f cl.exr
	cl -o cl.exr 2>err && same
	ok $? "$label: built anew, the same bytes"
	cmp good "$kept" && unused cl -o cl.exr 2>err && same
	ok $? "$label: and kept again"
}
# shellcheck disable=SC2317    # called by damaged
flip() { printf X | dd of="$kept" bs=1 seek="$1" conv=notrunc status=none; }
damaged 'a damaged binary' flip $(($(stat -c %s good) - 1000))
damaged 'a damaged key' flip 100
damaged 'half a file' truncate -s $(($(stat -c %s good) / 2)) "$kept"
damaged 'an empty file' truncate -s 0 "$kept"
cl --transport grid -o grid.exr
for f in cache/motes/*; do [ "$f" = "$kept" ] || other=$f; done
damaged "another program's file" cp "${other:-/dev/null}" "$kept"
is '' "$(find cache -type f ! -name '????????????????.cl')" 'nothing else is left in the cache'
nowhere() { # NAME ENVIRONMENT..: no place for a cache
	label=$1
	shift
	env "$@" "$MOTES_BUILD/bin/vrender" three.scene --backend opencl --samples 24 -o cl.exr 2>err && same
	ok $? "$label is no error"
}
nowhere 'a cache in a file' XDG_CACHE_HOME="$tmp/c.exr"
nowhere 'a cache in a folder that takes no files' XDG_CACHE_HOME=/proc
nowhere 'no home' -u HOME -u XDG_CACHE_HOME
nowhere 'a relative path, which does not count,' -u HOME XDG_CACHE_HOME=here
is '' "$(ls -d here 2>/dev/null)" 'nothing is put there'
mkdir home
nowhere 'a home without a cache' -u XDG_CACHE_HOME HOME="$tmp/home"
is 1 "$(find home/.cache/motes -name '*.cl' | wc -l)" 'it gets one'
done_testing
