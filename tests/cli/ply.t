#!/bin/sh
# Points of PLY files, as scanners and other programs write them, become tables.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

# points FORMAT COUNT: two faces of another element first, then COUNT points of four properties, a list and a byte among them; then faces
points() {
	perl -e '
		my ($format, $n) = @ARGV;
		my $big = $format eq "binary_big_endian" ? ">" : "<";
		print "ply\r\nformat $format 1.0\ncomment made by hand\nelement stop 2\nproperty list uchar short at\nproperty uchar of\nelement vertex $n\n";
		print "property float x\nproperty list uchar int colours\nproperty double y\nproperty float32 z\nproperty double radius\nproperty uint8 kind\n";
		print "element face 1\nproperty list uchar int corners\nend_header\n";
		my @rows = ([1.5, [1, -2], 0.1, -3, 10, 7], [2.5, [], 0.2, 4, 20.5, 255], [-1e3, [5], 0.3, 0, 1e-3, 0]);
		if ($format eq "ascii") {
			print "2 1 2 9\n0 8\n";
			print join(" ", $_->[0], scalar @{$_->[1]}, @{$_->[1]}, @$_[2 .. 5]), "\n" for @rows;
			print "3 0 1 2\n";
		} else {
			print pack "C(s2)$big C C C", 2, 1, 2, 9, 0, 8;
			print pack("f$big C", $_->[0], scalar @{$_->[1]}), pack("l$big*", @{$_->[1]}), pack("d$big f$big d$big C", @$_[2 .. 5]) for @rows;
			print pack "C(l3)$big", 3, 0, 1, 2;
		}' "$1" "$2"
}
cat >want <<'EOT'
# x:f32:m	y:f64:m	z:f32:m	radius:f64:um	kind:i32:1
1.5	0.1	-3	10	7
2.5	0.2	4	20.5	255
-1000	0.3	0	0.001	0
EOT
for format in ascii binary_little_endian binary_big_endian; do
	points $format 3 >p.ply
	txttab --units radius=um p.ply -o p.tab && tabtxt p.tab | sed 's/0\.10000000000000001/0.1/; s/0\.20000000000000001/0.2/; s/0\.29999999999999999/0.3/' >got
	cmp -s want got
	ok $? "$format"
	points $format 3 | txttab --units radius=um | cmp -s - p.tab
	ok $? "$format, from a pipe"
done
points ascii 3 | sed '/^3 0 1 2/d' >fewer.ply
sed 's/^element vertex 3/element vertex 4/' fewer.ply >four.ply
refused 'ascii: fewer points than it says' '^txttab: four.ply: is cut short: it says 4 of element vertex, and has 3' txttab -o four.tab four.ply
points binary_little_endian 4 >four.ply
refused 'binary: fewer points than it says' '^txttab: four.ply: is cut short: it says 4 of element vertex, and has 3' txttab -o four.tab four.ply
# bad NAME PATTERN SED..: the ASCII file changed so
bad() {
	points ascii 3 | sed "$3" >bad.ply
	refused "$1" "^txttab: bad.ply: $2" txttab -o bad.tab bad.ply
}
bad 'a format that is not known' 'line 2: the format is ascii' 's/^format.*/format text 1.0/'
bad 'no format' 'has no line with its format' '/^format/d'
bad 'a type that is not known' "line 8: 'half' is no type" 's/^property float x/property half x/'
bad 'a property of nothing' 'line 4: a property of no element' '/^element stop/d'
bad 'no vertices' 'has no vertices' 's/^element vertex/element point/'
# shellcheck disable=SC2016 # the last line
bad 'a header without an end' 'its header has no end' '/^end_header/,$d'
bad 'a property twice' 'property x stands twice' 's/^property float32 z/property float x/'
bad 'a word for a number' "line 20: column y: 'many' is not a number" 's/0\.2/many/'
bad 'too few numbers' "line 20: column kind: '' is not a number" 's/ 255$//'
bad 'too many numbers' 'line 20: has more than the 6 properties' 's/ 255$/ 255 3/'
bad 'a list that is cut short' 'line 20: list colours is cut short' 's/^2\.5 0 .*/2.5 3 1 2/'
bad 'a list of a length that is none' 'line 20: list colours has a length of -1' 's/^2\.5 0 /2.5 -1 /'
bad 'a number of vertices that is none' 'line 7: how many of element vertex' 's/^element vertex 3/element vertex -3/'

printf 'ply\nformat binary_little_endian 1.0\nelement nothing 999999999999999999\nelement vertex 1\nproperty char x\nend_header\n1' >much.ply
timeout 20 txttab much.ply | tabtxt | grep -q '^49$'
ok $? 'more elements of nothing than could ever be counted'

# the points as a cloud of drops
printf '# wavelength:f64:um\tradius:f64:um\tc_ext:f64:um^2\tc_sca:f64:um^2\n0.55\t10\t600\t500\n' | txttab -o xsect
printf '# wavelength:f64:um\ttheta:f64:deg\tp:f64:sr^-1\n0.55\t0\t0.0795774715\n0.55\t180\t0.0795774715\n' | txttab -o phase
points ascii 3 | sed 's/20\.5/10/; s/0\.001/10/; s/-1000/-1/' | txttab | medium-bake --xsect xsect --phase phase -o drops.medium
ok $? 'baked into a medium'
done_testing
