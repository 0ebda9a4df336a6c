# The kernels' files, in order, as one C string; includes are left out, since what they name comes before.
BEGIN { print "#include \"render/kernels_text.h\"\n\nconst char kernels_source[] =" }
/^#include/ { next }
{
	gsub(/["\\]/, "\\\\&")
	print "\t\"" $0 "\\n\""
}
END { print "\t;" }
