"""SciPy's Butterworth high-pass filter: `python3 scipy_filter.py < in.json > out.json`.

in:  [{"order": n, "cutoff": f_c, "sampling_rate": f_s, "series": [...], "sos": [...]}, ...]
     without "sos", SciPy designs the filter
out: [{"sos": [...], "at_rest": [...], "steady": [...], "both_ways": [...]}, ...]

SPDX-License-Identifier: LGPL-2.1-or-later
"""
import json
import sys

import numpy
from scipy import signal

answers = []
for case in json.load(sys.stdin):
    design = signal.butter(case["order"], case["cutoff"], "highpass", fs=case["sampling_rate"], output="sos")
    sos = numpy.array(case.get("sos", design))
    series = numpy.array(case["series"])
    answers.append({
        "sos": design.tolist(),
        "at_rest": signal.sosfilt(sos, series).tolist(),
        "steady": signal.sosfilt(sos, series, zi=signal.sosfilt_zi(sos) * series[0])[0].tolist(),
        "both_ways": signal.sosfiltfilt(sos, series).tolist(),
    })
json.dump(answers, sys.stdout)
