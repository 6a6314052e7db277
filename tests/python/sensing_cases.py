# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cases and responses of the tests of ciliaval.sensing."""

import numpy as np

import ciliaval as cv
from ciliaval import sensing
from ciliaval.sensing.response import shapes_up_to

NOISE = np.array([0.5e-6, 0.5e-6, 1e-6])
SENSOR = [-0.1e-3, 0.2e-3, -1.55e-3]
PAIR = sensing.Pair("elastica", "volume")

CASE = """
[case]
name = "one"
[cilium]
diameter = "3 mm"
[[cilium.segment]]
name = "base"
length = "3 mm"
young_modulus = "0.1 MPa"
poisson_ratio = 0.49
[[cilium.segment]]
name = "magnet"
length = "17 mm"
young_modulus = "3 MPa"
poisson_ratio = 0.49
magnetization = "75 kA/m"
[load]
type = "contact"
force = ["1 mN", "2.5 mN", "4 mN"]
height = "16 mm"
azimuth = "30 deg"
[sensor]
position = ["-0.1 mm", "0.2 mm", "-1.55 mm"]
[models]
mechanics = ["beam"]
fields = ["line"]
[models.elastica]
joints = "corrected"
[models.beam]
joints = "corrected"
"""
FLOW = CASE.replace(CASE[CASE.index("[load]") : CASE.index("[sensor]")], """[load]
type = "flow"
velocity = ["0.01 m/s", "0.3 m/s"]
azimuth = "200 deg"
""").replace('["beam"]', '["elastica"]').replace('["line"]', '["volume"]')  # fmt: skip
SWEEP = CASE.replace(CASE[CASE.index("[load]") : CASE.index("[sensor]")], """[load]
type = "sweep"
interference = "1 mm"
travel = "52 mm"
samples = 209
speed = "1 mm/s"
azimuth = "20 deg"
[surface]
profile = "trapezoid"
height = "1 mm"
top = "12 mm"
bottom = "12 mm"
flank = "1 mm"
radius = "0.5 mm"
friction = 0.3
""").replace('["-0.1 mm", "0.2 mm", "-1.55 mm"]', '[["-0.1 mm", "0.2 mm", "-1.55 mm"], ["2 mm", "0 mm", "-1.55 mm"]]')  # fmt: skip
SWEEP = SWEEP.replace('["beam"]', '["elastica"]').replace('["line"]', '["volume"]').replace('"corrected"', '"none"')


def noise_interval(frame):
    """The interval of a frame of loads by the noise alone."""
    return np.sqrt(frame["magnitude_interval"] ** 2 - frame["model_interval"] ** 2 - frame["input_interval"] ** 2)


def polar(size, azimuth):
    return np.stack([size * np.cos(azimuth), size * np.sin(azimuth)], axis=-1)


def paper_response(largest=4e-3, sensors=(SENSOR,), mechanics="elastica", field="volume", made={}):
    key = (largest, str(sensors), mechanics, field)
    if key not in made:
        case = cv.Case.from_text(CASE)
        made[key] = sensing.Response(case, field, shapes_up_to(case, mechanics, largest), sensors)
    return made[key]
