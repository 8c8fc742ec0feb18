#!/usr/bin/env python3
"""An estimator in Python, standard library only: dead reckoning, after half a second at rest that shows gravity and the
gyro's bias.

    plumbline run scenarios/quickstart.yaml --estimator "exec:python3 dead_reckoning.py"

Messages come on standard input and answers go to standard output; tools/outside/README.md describes both.
"""

import math
import struct
import sys

END, IMU = 0, 1
REST_NS = 500_000_000


def read_exactly(size):
    data = sys.stdin.buffer.read(size)
    if len(data) != size:
        sys.exit("the message stream was cut short")
    return data


def multiply(a, b):
    """The product of two quaternions (x, y, z, w)."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotate(q, v):
    x, y, z, w = q
    return multiply(multiply(q, (*v, 0.0)), (-x, -y, -z, w))[:3]


def rotation_about(axis, angle):
    """`axis` is of unit length."""
    return (*(math.sin(0.5 * angle) * a for a in axis), math.cos(0.5 * angle))


class DeadReckoning:
    def __init__(self):
        self.first_ns = self.stamp_ns = None
        self.samples = 0
        self.rate_sum = self.force_sum = (0.0, 0.0, 0.0)
        self.rotation = (0.0, 0.0, 0.0, 1.0)  # world from body, (x, y, z, w)
        self.position = self.velocity = (0.0, 0.0, 0.0)

    def add(self, stamp_ns, rate, force):
        """Returns the answer to an IMU sample."""
        if not all(map(math.isfinite, (*rate, *force))) or (self.samples and stamp_ns <= self.stamp_ns):
            return "none"
        if self.first_ns is None:
            self.first_ns = self.stamp_ns = stamp_ns
        dt = 1e-9 * (stamp_ns - self.stamp_ns)
        self.stamp_ns = stamp_ns
        if stamp_ns - self.first_ns < REST_NS:
            self.rest(rate, force)
        else:
            self.move(rate, force, dt)
        return " ".join(["pose", str(stamp_ns), *map(repr, self.position), *map(repr, self.rotation)])

    def rest(self, rate, force):
        """At rest the specific force points up, and the gyro reads its bias. The estimate starts with yaw 0."""
        self.samples += 1
        self.rate_sum = tuple(a + b for a, b in zip(self.rate_sum, rate))
        self.force_sum = tuple(a + b for a, b in zip(self.force_sum, force))
        fx, fy, fz = self.force_sum
        roll = rotation_about((1.0, 0.0, 0.0), math.atan2(fy, fz))
        pitch = rotation_about((0.0, 1.0, 0.0), math.atan2(-fx, math.hypot(fy, fz)))
        self.rotation = multiply(pitch, roll)

    def move(self, rate, force, dt):
        """The sample is the mean over the interval that ends at its stamp."""
        turn = [(r - b / self.samples) * dt for r, b in zip(rate, self.rate_sum)]
        angle = math.sqrt(sum(t * t for t in turn))
        half = rotation_about([t / angle for t in turn] if angle > 0.0 else (1.0, 0.0, 0.0), 0.5 * angle)
        ax, ay, az = rotate(multiply(self.rotation, half), force)
        acceleration = (ax, ay, az - 9.81)
        self.position = tuple(p + (v + 0.5 * a * dt) * dt for p, v, a in zip(self.position, self.velocity, acceleration))
        self.velocity = tuple(v + a * dt for v, a in zip(self.velocity, acceleration))
        rotation = multiply(multiply(self.rotation, half), half)
        length = math.sqrt(sum(c * c for c in rotation))
        self.rotation = tuple(c / length for c in rotation)


def main():
    magic, version, size = struct.unpack("<8sII", read_exactly(16))
    if magic != b"PLUMBMSG" or version != 1:
        sys.exit("no message stream of version 1")
    read_exactly(size)  # the calibration, YAML; dead reckoning needs none of it
    print("plumbline-odometry 1", flush=True)
    estimator = DeadReckoning()
    while True:
        kind, size, _delivery_ns = struct.unpack("<IIq", read_exactly(16))
        if kind == END:
            return
        payload = read_exactly(size)
        if kind != IMU:  # camera, depth, lidar: not looked at
            continue
        stamp_ns, *values = struct.unpack("<q6d", payload)
        print(estimator.add(stamp_ns, values[:3], values[3:]), flush=True)  # the next message comes after the answer


if __name__ == "__main__":
    main()
