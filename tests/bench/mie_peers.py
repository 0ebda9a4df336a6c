"""Lorenz-Mie codes from PyPI behind one interface. One thread.

usage: mie_peers.py list                               the peers that are here, a line each: name and version
       mie_peers.py NAME q <rows                        lines "x m_re m_im" in, "qext qsca g qback" out, "nan .." where it fails
       mie_peers.py NAME time M_RE M_IM X0 X1 COUNT [ANGLES]   seconds of CPU a size, of so many
                                                        log-spaced ones or as many as take 2 s, best of three
"""
import os
import sys
import time

out = os.fdopen(os.dup(1), "w")      # some codes print to standard output of their own accord
os.dup2(2, 1)
os.environ.update(OMP_NUM_THREADS="1", NUMBA_NUM_THREADS="1", MIEPYTHON_USE_JIT="1")


def miepython():
    import miepython
    import numpy as np

    def q(x, m):
        ext, sca, back, g = miepython.efficiencies_mx(m.conjugate(), np.asarray(x))
        return ext, sca, g, back

    def amplitudes(x, m, mu):
        for one in x:
            miepython.S1_S2(m.conjugate(), one, mu, norm="bohren")
    return q, amplitudes


def lxmie():
    import lxmie
    import math

    def q(x, m):
        n = len(x)
        r = lxmie.mie([m.real] * n, [m.imag] * n, list(x))
        return [s.q_ext for s in r], [s.q_sca for s in r], [s.asymmetry_parameter for s in r], [math.nan] * n

    def amplitudes(x, m, mu):
        angles = [math.acos(c) for c in mu]
        for one in x:
            lxmie.mie_amplitudes(m.real, m.imag, one, angles)
    return q, amplitudes


def scattnlay():
    import scattnlay
    import numpy as np

    def q(x, m):
        x = np.asarray(x).reshape(-1, 1)
        r = scattnlay.scattnlay(x, np.full(x.shape, m))
        return r[1], r[2], r[6], r[4]

    def amplitudes(x, m, mu):
        x = np.asarray(x).reshape(-1, 1)
        scattnlay.scattnlay(x, np.full(x.shape, m), theta=np.arccos(mu))
    return q, amplitudes


PEERS = {"miepython": miepython, "lxmie": lxmie, "scattnlay": scattnlay}


def main():
    if sys.argv[1] == "list":
        from importlib.metadata import version, PackageNotFoundError
        for name in PEERS:
            try:
                PEERS[name]()
                print(name, version({"scattnlay": "python-scattnlay"}.get(name, name)), file=out)
            except (ImportError, PackageNotFoundError):
                pass
        return
    q, amplitudes = PEERS[sys.argv[1]]()
    if sys.argv[2] == "q":
        for line in sys.stdin:
            x, re, im = map(float, line.split())
            try:
                r = [float(v[0]) if hasattr(v, "__len__") else float(v) for v in q([x], complex(re, im))]
            except Exception:
                r = [float("nan")] * 4
            print("%.17g %.17g %.17g %.17g" % tuple(r), file=out, flush=True)
        return
    import numpy as np
    re, im, x0, x1 = map(float, sys.argv[3:7])
    count, angles = int(sys.argv[7]), int(sys.argv[8]) if len(sys.argv) > 8 else 0
    x = np.geomspace(x0, x1, count)
    mu = np.cos(np.linspace(0, np.pi, angles)) if angles else None
    run = (lambda s: amplitudes(s, complex(re, im), mu)) if angles else (lambda s: q(s, complex(re, im)))
    run(x[:1])      # compiles
    begin = time.process_time()
    run(x[:1])
    one = time.process_time() - begin
    if one * count > 2:
        count = max(1, int(2 / one))
        x = np.geomspace(x0, x1, count)
    best = float("inf")
    for _ in range(3):
        begin = time.process_time()
        run(x)
        best = min(best, time.process_time() - begin)
        if best > 2:
            break
    print("%.6g" % (best / count), file=out)


main()
