/* Units, to the bit. */
#include "base/unit.h"
#include "support/tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void length(const char *text, int exponent, double want)
{
	double got = -1;
	const char *bad = unit_length(text, exponent, &got);
	ok(!bad && got == want, "%s is %.17g", text, want);
}

static void refused(const char *bad, const char *text, const char *why)
{
	ok(bad && strstr(bad, why), "'%s' is refused: %s", text, bad ? bad : "(taken)");
}

static void lengths(const char *text, int by_step, size_t n, size_t i, double want)
{
	struct reals r = { NULL, 0 };
	const char *bad = unit_lengths(text, -6, by_step, &r);
	ok(!bad && r.n == n && r.v[i] == want, "%s has %zu values, and value %zu is %.17g", text, n, i, want);
	free(r.v);
}

static void wavelengths(const char *text, size_t n, size_t i, double want)
{
	struct reals r = { NULL, 0 };
	const char *bad = unit_wavelengths(text, -6, &r);
	ok(!bad && r.n == n && r.v[i] == want, "%s has %zu values, and value %zu is %.17g", text, n, i, want);
	free(r.v);
}

int main(void)
{
	double v;
	long long whole;
	struct reals r;

	length("550nm", -6, 550.0 / 1000);
	length("0.3nm", -6, 0.3 / 1000);
	length("1um", -6, 1);
	length("1e-1um", -6, 0.1);
	length("+2.5mm", -6, 2500);
	length(".5cm", -6, 5000);
	length("0.1m", -6, 100000);
	length("3km", 0, 3000);
	length("7um", 0, 7 / 1e6);
	length("1nm", 0, 1 / 1e9);
	length("0.55\xc2\xb5m", -6, 0.55);
	length("0.55\xce\xbcm", -6, 0.55);
	refused(unit_length("0.55\xc2\xb6m", -6, &v), "0.55\xc2\xb6m", "unknown unit");
	refused(unit_length("94GHz", -6, &v), "94GHz", "unknown unit");
	refused(unit_length("10", -6, &v), "10", "without a unit");
	refused(unit_length("10 um", -6, &v), "10 um", "unknown unit");
	refused(unit_length("10UM", -6, &v), "10UM", "unknown unit");
	refused(unit_length("um", -6, &v), "um", "not a length");
	refused(unit_length("", -6, &v), "", "not a length");
	refused(unit_length("0x10um", -6, &v), "0x10um", "not a length");
	refused(unit_length("nanum", -6, &v), "nanum", "not a length");
	refused(unit_length("1e308km", -6, &v), "1e308km", "too large");

	wavelengths("94GHz", 1, 0, 299792458.0 / 94e3);
	wavelengths("94GHz,550nm,1THz,1MHz,300kHz", 5, 2, 299792458.0 / 1e6);
	wavelengths("94GHz,550nm,1THz,1MHz,300kHz", 5, 1, 550.0 / 1000);
	wavelengths("94GHz,550nm,1THz,1MHz,300kHz", 5, 4, 299792458.0 / 0.3);
	wavelengths("90GHz:100GHz:1GHz", 11, 4, 299792458.0 / 94e3);
	wavelengths("380nm:780nm:10nm", 41, 17, 550.0 / 1000);
	refused(unit_wavelengths("0GHz", -6, &r), "0GHz", "not a frequency");
	refused(unit_wavelengths("-1GHz", -6, &r), "-1GHz", "not a frequency");
	refused(unit_wavelengths("94ghz", -6, &r), "94ghz", "kHz, MHz, GHz");
	refused(unit_wavelengths("94GHz:1um:1nm", -6, &r), "94GHz:1um:1nm", "mixes");
	refused(unit_wavelengths("1GHz:2GHz:1nm", -6, &r), "1GHz:2GHz:1nm", "mixes");
	refused(unit_wavelengths("1e-320kHz", -6, &r), "1e-320kHz", "too large");
	free(r.v);

	lengths("380nm:780nm:10nm", 1, 41, 17, 550.0 / 1000);
	lengths("380nm:780nm:10nm", 1, 41, 40, 780.0 / 1000);
	lengths("0.1um:0.3um:0.1um", 1, 3, 2, 0.1 + 2 * 0.1);
	lengths("1um:1um:1um", 1, 1, 0, 1);
	lengths("1um:2.5um:1um", 1, 2, 1, 2);
	lengths("0.1um:100um:200", 0, 200, 199, 100);
	lengths("0.1um:100um:4", 0, 4, 0, 0.1);
	lengths("100nm:1mm:5", 0, 5, 2, 10);
	lengths("5um:5um:1", 0, 1, 0, 5);
	lengths("1um,20nm,3mm", 0, 3, 2, 3000);
	refused(unit_lengths("1um:2um", -6, 0, &r), "1um:2um", "not a range");
	refused(unit_lengths("1um::2um:3", -6, 0, &r), "1um::2um:3", "not a range");
	refused(unit_lengths(":1um:2um:3", -6, 0, &r), ":1um:2um:3", "not a range");
	refused(unit_lengths("1um:2um:", -6, 0, &r), "1um:2um:", "not a number");
	refused(unit_lengths("1um:2um:3um", -6, 0, &r), "1um:2um:3um", "not a number");
	refused(unit_lengths("2um:1um:3", -6, 0, &r), "2um:1um:3", "FROM <= TO");
	refused(unit_lengths("0um:1um:3", -6, 0, &r), "0um:1um:3", "0 < FROM");
	refused(unit_lengths("1um:2um:2.5", -6, 0, &r), "1um:2um:2.5", "whole COUNT");
	refused(unit_lengths("1um:2um:0um", -6, 1, &r), "1um:2um:0um", "STEP > 0");
	refused(unit_lengths("1um:2um:1e308km", -6, 1, &r), "1um:2um:1e308km", "too large");
	refused(unit_lengths("1um:2um:1e-300um", -6, 1, &r), "1um:2um:1e-300um", "too many");
	refused(unit_lengths("1um:2um:1e12", -6, 0, &r), "1um:2um:1e12", "too many");
	refused(unit_lengths("1um,,2um", -6, 0, &r), "1um,,2um", "not a length");
	free(r.v);
	refused(unit_lengths("1um,2", -6, 0, &r), "1um,2", "without a unit");
	free(r.v);

	ok(!unit_int("1e8", &whole) && whole == 100000000, "1e8 is a whole number");
	ok(!unit_int("-9007199254740992", &whole) && whole == -9007199254740992, "-2^53 is one");
	refused(unit_int("1.5", &whole), "1.5", "whole");
	refused(unit_int("1e16", &whole), "1e16", "whole");
	ok(!unit_concentration("100/cm3", &v) && v == 1e8, "100/cm3 is 1e8 m^-3");
	ok(!unit_concentration("4e12/m3", &v) && v == 4e12, "4e12/m3 is 4e12 m^-3");
	refused(unit_concentration("4e12", &v), "4e12", "without a unit");
	refused(unit_concentration("-1/m3", &v), "-1/m3", "range");
	ok(!unit_bytes("256MiB", &v) && v == 0x1p28, "256MiB is 2^28 bytes");
	refused(unit_bytes("1MB", &v), "1MB", "unknown unit");
	refused(unit_bytes("1e308GiB", &v), "1e308GiB", "range");
	refused(unit_real("1e999", &v), "1e999", "too large");
	return done_testing();
}
