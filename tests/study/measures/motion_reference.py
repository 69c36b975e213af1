"""Smoothness and way of closed-form movements, written from the literature and not from the program:

low-pass   Butterworth of 2nd order by the bilinear transform with prewarping (Oppenheim and Schafer, Discrete-Time
           Signal Processing, 7.2), forward and backward (Gustafsson 1996) from the steady state of the first value, on
           the series extended at both ends by its point reflection
SPARC      Balasubramanian, Melendez-Calderon, Roby-Brami and Burdet 2015, J NeuroEng Rehabil 12:112: arc length of the
           normalised amplitude spectrum of the speed up to 10 Hz, between the first and the last frequency with at least
           0.05 of the largest amplitude; zero-padded 16 times
LDLJ       Hogan and Sternad 2009, J Motor Behavior 41: -ln(T^3 / peak speed^2 times the integral of jerk^2)

python3 motion_reference.py prints a line for each movement: name, encoder step, raw path, path, SPARC, LDLJ and the share
of the jerk that the step leaves behind; then the numbers that the text of a formula holds."""
import cmath
import math
import struct

FS, FC = 1000.0, 10.0


def lowpass(x, fc=FC):
    k = math.tan(math.pi * fc / FS)
    a0 = 1 + math.sqrt(2) * k + k * k
    b = [k * k / a0, 2 * k * k / a0, k * k / a0]
    a = [2 * (k * k - 1) / a0, (1 - math.sqrt(2) * k + k * k) / a0]
    pad = min(len(x) - 1, round(3 * FS / fc))
    y = [2 * x[0] - x[i] for i in range(pad, 0, -1)] + list(x) + [2 * x[-1] - x[-1 - i] for i in range(1, pad + 1)]
    for _ in range(2):
        x1 = x2 = y1 = y2 = y[0]  # the filter has gain 1 at rest
        out = []
        for v in y:
            w = b[0] * v + b[1] * x1 + b[2] * x2 - a[0] * y1 - a[1] * y2
            x2, x1, y2, y1 = x1, v, y1, w
            out.append(w)
        y = out[::-1]
    return y[pad:len(y) - pad] if pad else y


def norm(v):
    return math.sqrt(sum(c * c for c in v))


def steps(points):
    return [[b - a for a, b in zip(p, q)] for p, q in zip(points, points[1:])]


def fft(x):
    n = len(x)
    if n == 1:
        return x
    even, odd = fft(x[0::2]), fft(x[1::2])
    t = [cmath.exp(-2j * math.pi * k / n) * odd[k] for k in range(n // 2)]
    return [even[k] + t[k] for k in range(n // 2)] + [even[k] - t[k] for k in range(n // 2)]


def sparc(speed):
    n = 2 ** (math.ceil(math.log2(len(speed))) + 4)
    amplitude = [abs(c) for c in fft([complex(v) for v in speed] + [0j] * (n - len(speed)))]
    top = max(amplitude)
    upto = [a / top for a in amplitude[:int(FC * n / FS) + 1]]
    over = [i for i, a in enumerate(upto) if a >= 0.05]
    part = upto[over[0]:over[-1] + 1]
    width = 1.0 / (len(part) - 1)
    return -sum(math.sqrt(width ** 2 + (b - a) ** 2) for a, b in zip(part, part[1:]))


def ldlj(points, speed):
    third = steps(steps(steps(points)))
    integral = sum(norm(v) ** 2 for v in third) * FS ** 6 / FS
    duration = (len(points) - 1) / FS
    return -math.log(duration ** 3 / max(speed) ** 2 * integral), integral


class Noise:
    """Uniform in -1 ... 1 from an integer sequence that any language computes alike (Park and Miller 1988)."""

    def __init__(self):
        self.state = 1

    def __call__(self):
        self.state = self.state * 48271 % 2147483647
        return 2.0 * self.state / 2147483647 - 1.0


def minimum_jerk(s):
    return s ** 3 * (10 - 15 * s + 6 * s * s)


MOVEMENTS = {  # 1 s each; metres
    "line": lambda s: [0.08 * s, 0.05 * s, -0.03 * s],
    "circle": lambda s: [0.03 * math.cos(2 * math.pi * s), 0.03 * math.sin(2 * math.pi * s), 0.02],
    "minimum_jerk": lambda s: [0.1 * minimum_jerk(s), 0.0, 0.0],
}


def recorded(movement, step, noise=2e-6):
    """1001 ticks, with noise up to 2 um and an encoder of that step, kept in 4 bytes."""
    random = Noise()
    points = []
    for k in range(1001):
        point = [c + noise * random() for c in movement(k / 1000)]
        if step > 0:
            point = [step * math.floor(c / step + 0.5) for c in point]
        points.append([struct.unpack("f", struct.pack("f", c))[0] for c in point])
    return points


if __name__ == "__main__":
    variance_factor = 2 * (2 * math.pi) ** 6 * FC ** 7 / FS * math.gamma(1.75) * math.gamma(0.25) / 4
    for name, movement in MOVEMENTS.items():
        for step in (None, 0, 5e-6, 20e-6, 60e-6):
            raw = [movement(k / 1000) for k in range(1001)] if step is None else recorded(movement, step)
            smooth = list(zip(*(lowpass(axis) for axis in zip(*raw))))
            moved = [norm(v) for v in steps(smooth)]
            speed = [FS * v for v in moved]
            log_jerk, integral = ldlj(smooth, speed)
            rest = sum((a - b) ** 2 for p, q in zip(raw, smooth) for a, b in zip(p, q)) / len(raw)
            print("%-13s %8s  raw %.6f  path %.6f  sparc %.6f  ldlj %.6f  left %.4f" % (
                name, "ideal" if step is None else step, sum(norm(v) for v in steps(raw)), sum(moved), sparc(speed),
                log_jerk, rest * variance_factor / integral))
    print("jerk^2 per second of a position's variance: %.6g / s^6" % variance_factor)
    ideal = [norm(v) * FS for v in steps([MOVEMENTS["minimum_jerk"](k / 1000) for k in range(1001)])]
    print("minimum jerk without a filter: sparc %.6f, ldlj %.6f (closed form %.6f)" % (
        sparc(ideal), ldlj([MOVEMENTS["minimum_jerk"](k / 1000) for k in range(1001)], ideal)[0], -math.log(204.8)))
