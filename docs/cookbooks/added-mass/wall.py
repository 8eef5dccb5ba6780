"""Writes wall.obj, a round wall of 720 straight pieces inside and outside; solid is on the left of each piece."""
from math import cos, pi, sin

N, INNER, OUTER = 720, .3, .48
with open("wall.obj", "w") as file:
    for radius in (INNER, OUTER):
        for k in range(N):
            file.write(f"v {radius * cos(2 * pi * k / N)} {radius * sin(2 * pi * k / N)} 0\n")
    for k in range(N):
        after = (k + 1) % N
        file.write(f"l {after + 1} {k + 1}\nl {N + k + 1} {N + after + 1}\n")
