#!/bin/sh
# Nothing is lost in silence: where an output goes, what is read, what a number may be; what would not end is refused.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/media.sh
. "$top/tests/support/media.sh"
sanitized=
case $MOTES_BUILD in *asan*) sanitized=1 ;; esac      # its memory is not to be limited
# starved KB COMMAND..: with so much memory
# shellcheck disable=SC3045    # not POSIX, but what sh is on Linux has it
starved() { (ulimit -v "$1"; shift; exec "$@"); }

# ---- outputs
printf '# radius:f64:um\tweight:f64:1\n1\t0.5\n3\t0.5\n' >t.txt
txttab t.txt -o t.tab
mkdir d
echo old >d/real
ln -s d/real link
txttab t.txt -o link && [ -L link ] && cmp -s t.tab d/real
ok $? 'a symbolic link is written through'
ln -s new d/other && ln -s d/other dangling
txttab t.txt -o dangling && [ -L dangling ] && [ -L d/other ] && cmp -s t.tab d/new
ok $? 'two of them, that lead to nothing yet'
ln -s loop.b loop.a && ln -s loop.a loop.b
refused 'links in a circle' '^txttab: loop.a: cannot open: Too many levels' txttab t.txt -o loop.a
ln -s /proc/self/fd/1 output         # as /dev/stdout is, which a failure of this test shall not harm
txttab t.txt -o output >f && [ -L output ] && cmp -s t.tab f
ok $? 'a link to standard output, which is a file'
echo first >f
txttab t.txt -o output >>f && tail -n +2 f | cmp -s - t.tab
ok $? 'and one that holds something, which is not lost'
txttab t.txt -o output | cmp -s - t.tab && [ -L output ] && txttab t.txt -o /dev/fd/3 3>f && cmp -s f t.tab
ok $? 'into a pipe; another descriptor'
mkfifo pipe && { cat pipe >f & } && txttab t.txt -o pipe && wait && [ -p pipe ] && cmp -s f t.tab
ok $? 'a named pipe'
# Devices of the test's own, which a failure may harm; without the right to make them, the system's, which no failure can.
if ! { mknod null c 1 3 && echo >null; } 2>err; then rm -f null; ln -s /dev/null null; fi
if ! { mknod full c 1 7 && : >full; } 2>err; then rm -f full; ln -s /dev/full full; fi
txttab t.txt -o null && [ -c null ]
ok $? 'a device'
refused 'a full one' '^txttab: full: cannot write: No space' txttab t.txt -o full
echo old >private && chmod 640 private && txttab t.txt -o private
is '640 0' "$(stat -c %a private) $(cmp -s private t.tab; echo $?)" 'a file keeps its mode'
echo old >read-only && chmod 440 read-only
refused 'one without permission to write, whoever asks' '^txttab: read-only: is read-only' txttab t.txt -o read-only
is old "$(cat read-only)" 'and is as it was'
if [ "$(id -u)" = 0 ]; then
	echo old >owned && chown 65534:65534 owned && txttab t.txt -o owned
	is '65534 65534 0' "$(stat -c '%u %g' owned) $(cmp -s owned t.tab; echo $?)" 'a file keeps its owner'
else
	skip 'a file keeps its owner' 'needs root'
fi
echo old >one && ln one two && txttab t.txt -o one && cmp -s two t.tab
ok $? 'a file of two names is one still'
txttab t.tab -o two 2>err
is '2 0' "$? $(cmp -s two t.tab; echo $?)" 'and is as it was after a failure'
cp t.tab same && ln same same.2 && tabtxt same -o same && cmp -s same.2 t.txt
ok $? 'an output may be the input'

# ---- descriptors that are closed
tabtxt t.tab -o f 2>&- && cmp -s f t.txt
ok $? 'without standard error'
speak() { mie-phase --particle 1.5 --size-parameter 20000 --tolerance 1e-2 --theta 0,90,180 --verbose -o "$1"; }
speak quiet 2>err && speak f 2>&- && cmp -s f quiet
is '0 1' "$? $(wc -l <err)" 'and what it would have got does not go into the output'
tabtxt t.tab >&- 2>err
is '2 tabtxt: standard output: cannot write: Bad file descriptor' "$? $(cat err)" 'a closed standard output is an error'
tabtxt <&- 2>err
is '2 tabtxt: standard input: cannot read: Bad file descriptor' "$? $(cat err)" 'and so is a closed standard input'
oiiotool --pattern noise 8x8 3 -d float -o a.exr
imgcmp --difference picture a.exr a.exr >/dev/full 2>err
is '2 0' "$? $(find . -name 'picture*' | wc -l)" 'imgcmp leaves no picture behind a failure'

# ---- inputs
hg 0.5 >hg.phase
xsections 1e6 1e6 >one.xsect
sizes 1 >one.psd

# ---- room for temporary files, and memory
awk 'BEGIN { print "# radius:f64:um"; for (i = 1; i <= 100000; i++) print i }' | txttab -o big.tab
(trap '' XFSZ; ulimit -f 64; exec tabtxt --npy big.tab) 2>err | cat >f
is '0 tabtxt: temporary file: cannot write: File too large' "$(wc -c <f) $(cat err)" 'tabtxt --npy without room for a temporary file'
if [ $sanitized ]; then
	skip 'txttab without memory for a line' 'the sanitizer has its own memory'
else
	{ cat t.txt; head -c 200000000 /dev/zero | tr '\0' 0; printf '1\t1\n'; } | starved 100000 txttab >f 2>err
	is 'txttab: standard input: cannot read: Cannot allocate memory' "$(cat err)" 'txttab without memory for a line'
	refused 'which leaves no whole table' 'f: the table is cut short' tabtxt f
fi
# Where memory begins to do, and in steps below: an answer, or one line that there is none.
hungry() {
	name=$1 wrong='' low=1000 high=400000
	shift
	while [ $((high - low)) -gt 16 ]; do
		kb=$(((low + high) / 2))
		if starved $kb "$@" >/dev/null 2>&1; then high=$kb; else low=$kb; fi
	done
	for step in $(seq 40); do
		kb=$((high - step * step * 2))
		starved $kb "$1" --version >/dev/null 2>&1 || break      # it is not even loaded
		starved $kb "$@" >f 2>err
		status=$?
		case "$status $(cat err)" in
		'0 ' | "2 $1: "*'out of memory' | "2 $1: "*'annot allocate memory') ;;
		*) wrong="$wrong $kb: $status $(head -1 err)" ;;
		esac
	done
	is '' "$wrong" "$name: with little memory"
}
printf '# radius:f64:um\tweight:f64:1\n400\t0.25\n401\t0.25\n402\t0.25\n403\t0.25\n' | txttab -o large.tab
if [ $sanitized ]; then
	skip 'little memory' 'the sanitizer has its own'
else
	export OMP_NUM_THREADS=1
	hungry 'mie-phase --average' mie-phase --particle 1.5 --wavelength 550nm --average --direct --theta 0:180:18 large.tab
	hungry 'mie-phase' mie-phase --particle 1.5 --size-parameter 100000 --theta 0,90,180
	hungry 'xsect' xsect --particle 1.5+0.01i --wavelength 550nm --method mie large.tab
	hungry 'medium-bake' medium-bake --xsect one.xsect --phase hg.phase --psd one.psd --concentration 1/m3 --box 1m,1m,1m -o m
	hungry 'tabtxt' tabtxt big.tab
	export OMP_NUM_THREADS=2
fi

# ---- media: what is written can be read, and what is read is right
rm -f m
bake() { medium-bake --xsect one.xsect --phase hg.phase "$@"; }
# f4 SHAPE VALUES..: a NumPy array
f4() {
	perl -e 'my $h = sprintf "{%sdescr%s: %s<f4%s, %sfortran_order%s: False, %sshape%s: (%s), }", ("\x27") x 6, "\x27", "\x27", shift;
		$h .= " " x ((54 - length $h) % 64) . "\n";
		print "\x93NUMPY\x01\x00", pack("v", length $h), $h, pack "f<*", @ARGV' "$@"
}
f4 1,1,2 1 3e30 >strong.npy
f4 1,1,2 0 0 >empty.npy
refused 'a density of 1e30' 'm: is not written: .*out of range' bake --psd one.psd --concentration 1e-6/m3 --box 1m,1m,1m --density strong.npy -o m
refused 'a concentration of 1e308' 'm: is not written: .*too many' bake --psd one.psd --concentration 1e308/m3 --box 1m,1m,1m -o m
printf '# x:f64:m\ty:f64:m\tz:f64:m\tradius:f64:um\n999999990\t0\t0\t1000\n' | txttab -o far.tab
refused 'a particle at 1e9 m' 'far.tab: row 1: a position is not within' bake far.tab -o m
is '' "$(find . -name m)" 'and none of these left a file'
printf '# x:f64:m\ty:f64:m\tz:f64:m\tradius:f64:um\n4e8\t0\t0\t1000\n0\t0\t0\t1000\n' | txttab | bake -o far.medium
cat >scene <<'EOT'
camera = { position = [0.0, 0.0, 9.0]; target = [0.0, 0.0, 0.0]; fov = 20.0; resolution = [8, 8]; };
medium = { file = "m"; };
lights = ( { type = "sun"; direction = [0.0, -1.0, 0.0]; irradiance = 3.0; } );
EOT
# shot FILE [OPTION..]: of this medium
shot() { sed "s/\"m\"/\"$1\"/" scene >shot.scene; shift; vrender shot.scene --samples 4 "$@"; }
shot far.medium -o f
ok $? 'nearer ones are written, and read'
bake --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m -o cube.medium
shot cube.medium -o cube.exr
# forged NAME VALUE: the medium as it was written before, with cumulative probabilities, all of them this; the checksum is right
forged() {
	perl -MCompress::Zlib -0777 -pe 'BEGIN { $value = hex pop }
		/^section\tp\t(\d+)\n/m or die; my $n = $1; my $p = -1; my ($head, $body) = (substr($_, 0, index($_, "\n\n") + 2), $_);
		my @size = (wavelength => 8, radius => 8, count => 8, c_ext => 8, c_sca => 8, node => 4, theta => 4, p => 4, particle => 4,
			first => 4, voxel_count => 4, density => 4);
		my ($at, $out, $new) = (length $head, "", $head);
		$new =~ s/^(section\tp\t\d+\n)/$1section\tcdf\t$n\n/m;
		my $put = sub { $new .= "\0" x (-length($new) % 64) . $_[0] };
		while (my ($name, $size) = splice @size, 0, 2) {
			my ($count) = $head =~ /^section\t$name\t(\d+)$/m;
			$at += -$at % 64;
			$put->(substr $body, $at, $count * $size);
			$at += $count * $size;
			$put->(pack "V*", ($value) x $n) if $name eq "p";
		}
		$put->("");
		$new .= pack "Q<", length($new) + 16;
		$_ = $new . pack "VV", crc32($new), 0' cube.medium "$2" >"$1"
}
for value in f0000000 0; do
	forged old.medium $value && shot old.medium -o f && imgcmp cube.exr f >out
	ok $? "a medium of before, with cumulative probabilities that are all 0x$value: they are not used"
done
forged other.medium 0 && perl -MCompress::Zlib -0777 -i -pe 's/voxels\t1\t1\t1/voxels\t1\t1\t2/;
	substr($_, -8, 4) = pack "V", crc32 substr $_, 0, -8' other.medium
refused 'a medium that does not agree with itself' 'other.medium: damaged medium: its density does not agree' shot other.medium -o f

# ---- what has no end, or takes too much
bake --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m --density empty.npy -o empty.medium
shot empty.medium --transport grid -o f
ok $? 'a grid with nothing in it'
bake --psd one.psd --concentration 5e15/m3 --box 2m,2m,2m -o deep.medium
sed 's/"m"/"deep.medium"/' scene >deep.scene
for transport in continuous grid; do
	refused "an optical depth of 1e10 without absorption: $transport" 'deep.medium: optical depth 1e\+10 .*without absorption' \
		timeout 20 vrender deep.scene --transport $transport -o f
done
xsections 1e6 9e5 >one.xsect
bake --psd one.psd --concentration 5e15/m3 --box 2m,2m,2m -o deep.medium
timeout 20 vrender deep.scene --samples 1 -o f
ok $? 'with absorption it is as good as any'
# shellcheck disable=SC2046
f4 8,8,8 1e9 $(yes 1 | head -511) >corner.npy
timeout 20 particles --psd one.psd --count 1000 --sphere 1m --density corner.npy | tabtxt >out
is 1001 "$(wc -l <out)" 'a density that is large only outside the sphere'
# shellcheck disable=SC2046
printf 'cmd\tc%s\n' $(seq 90000) >commands
perl -MCompress::Zlib -0777 -ne '$_ = "#?MOTES-TAB 1\n" . $_ . "col\tradius\tf64\tum\n\n" . pack("Vd<VQ<", 8, 1, 0, 1);
	print $_, pack "V", crc32 $_' commands >long.tab
refused 'a history of 90000 commands' 'long.tab: damaged table: its history is of too many' timeout 10 tabtxt long.tab
{ printf 'camera = { '; seq -f 'k%.0f=1;' 60000; echo '};'; } >keys.scene
refused 'a scene of 60000 keys' 'keys.scene: has more than 4096 keys' timeout 10 vrender keys.scene -o f
if [ $sanitized ]; then
	skip 'a size parameter of 1e7 at three angles' 'the sanitizer has its own memory'
else
	OMP_NUM_THREADS=1 starved 800000 mie-phase --particle 1.5 --size-parameter 1e7 --angles 3 -o f
	ok $? 'a size parameter of 1e7 at three angles takes little more than its coefficients'
fi
refused 'all the angles that 1e7 would take' 'takes too many angles' timeout 10 mie-phase --particle 1.5 --size-parameter 1e7 -o f
printf '# radius:f64:um\tweight:f64:1\n800000\t1\n' | txttab -o giant.tab
refused 'and those of a mean' 'too many angles' timeout 10 mie-phase --particle 1.5 --wavelength 550nm --average --tolerance 1e-6 giant.tab

# ---- numbers that are none
coefficients() {
	printf '# x:f64:1\thost_re:f64:1\thost_im:f64:1\tn:i32:1\ta_re:f64:1\ta_im:f64:1\tb_re:f64:1\tb_im:f64:1\n1\t1\t0\t1\t%s\t0\t0\t0\n' "$1" | txttab
}
for tool in xsect 'mie-phase --angles 3'; do
	for value in 1e308 1e160; do
		coefficients $value >c.tab
		# shellcheck disable=SC2086
		refused "$tool: coefficients of $value" 'c.tab: row 1: a coefficient is out of range' $tool c.tab
	done
	for value in 0 1e-200; do
		coefficients $value >c.tab
		# shellcheck disable=SC2086
		refused "$tool: coefficients of $value" 'c.tab: x = 1: no coefficient is above 1e-150' $tool c.tab
	done
done
for m in 1e-300+1.4142135623730951i 1e-9+1.414213562373095i 1e-300+1.2247448713915889i 1.998001998001998; do
	xsect --method evans-fournier --particle $m --size-parameter 1e-8:1e7:50 2>/dev/null | tabtxt | tail -n +2 >out
	is '50 0' "$(wc -l <out) $(grep -ciE 'nan|inf' out)" "Evans and Fournier's formula at $m"
done
done_testing
