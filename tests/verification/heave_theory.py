#!/usr/bin/python3
"""Motion of a half-submerged disc that is let go off its draft, by linear theory of deep water: prints the numbers that
the study heave-decay refers to, and fails if that file has others.

Units of the disc's radius, gravity and the water's density. Added mass A and damping B of a heaving disc come from
Ursell's (1949) source and wave-free multipoles, the motion from
    (M + A_inf) x'' + int_0^t K(t - s) x'(s) ds + 2 x = 0,   K(t) = 2/pi int_0^inf B(w) cos(w t) dw,
as Maskell and Ursell (1970) posed it. usage: heave_theory.py STUDY.xml
"""
import re
import sys

import numpy as np
from scipy.special import exp1

MASS = ADDED_MASS_AT_ONCE = np.pi / 2
STIFFNESS = 2.0


def added_mass_and_damping(frequency, n_multipoles=24, n_points=96):
    """By least squares over points of the disc; theta is measured from below."""
    k = frequency**2
    theta = (np.arange(n_points) + 0.5) / n_points * np.pi / 2
    z = np.exp(-1j * theta)
    standing = np.exp(-k * z) * (exp1(-k * z) + 1j * np.pi)  # its real part is the principal value
    wave = np.exp(-k * z)
    potentials = [standing.real + 1j * np.pi * wave.real]
    slopes = [((-k * standing - 1 / z) * z).real + 1j * np.pi * (-k * wave * z).real]
    for m in range(1, n_multipoles):
        even, odd = np.cos(2 * m * theta), np.cos((2 * m - 1) * theta)
        potentials.append(even + k / (2 * m - 1) * odd + 0j)
        slopes.append(-2 * m * even - k * odd + 0j)
    matrix = np.array(slopes).T
    sizes = np.abs(matrix).max(axis=0)
    strengths = np.linalg.lstsq(matrix / sizes, np.cos(theta) + 0j, rcond=None)[0] / sizes
    pressure = 1j * frequency * (np.array(potentials).T @ strengths)
    force = -2 * np.sum(pressure * np.cos(theta)) * (np.pi / 2 / n_points)
    return force.imag / frequency, -force.real


def swing(end=9.0, dt=0.01):
    """Times and heights; trapezoidal rules."""
    frequencies = np.linspace(0, 9, 600)
    damping = np.array([0] + [added_mass_and_damping(w)[1] for w in frequencies[1:]])
    times = np.arange(0, end + dt / 2, dt)
    memory = 2 / np.pi * np.trapz(damping * np.cos(np.outer(times, frequencies)), frequencies, axis=1)
    x, v = np.zeros_like(times), np.zeros_like(times)
    x[0] = 1
    inertia = (MASS + ADDED_MASS_AT_ONCE) / dt
    remembered = 0.0
    for i in range(1, len(times)):
        known = dt * (memory[i:0:-1] @ v[:i])  # v[0] = 0
        now = 0.5 * dt * memory[0]
        right = inertia * v[i - 1] - (remembered + known) / 2 - STIFFNESS * (x[i - 1] + dt / 4 * v[i - 1])
        v[i] = right / (inertia + now / 2 + STIFFNESS * dt / 4)
        x[i] = x[i - 1] + dt / 2 * (v[i - 1] + v[i])
        remembered = known + now * v[i]
    return times, x


def main():
    # Limits of A: logarithmic at low frequencies, pi/2 at high ones.
    assert abs(added_mass_and_damping(9.0)[0] - ADDED_MASS_AT_ONCE) < 0.01
    times, x = swing()
    numbers = {"first trough": x.min(), "first crest": x[times > 4].max(),
               "height at 5 sqrt(R/g)": np.interp(5, times, x)}
    text = open(sys.argv[1]).read()
    wrong = False
    for name, number in numbers.items():
        reference = re.search(f'name="{re.escape(name)}">.*?name="Reference" type="string" value="([^"]*)"', text, re.S).group(1)
        stated = float(reference)
        print(f"{name}: {number:.5f}; the study has {stated:.5f}")
        wrong = wrong or abs(stated / number - 1) > 0.003
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
