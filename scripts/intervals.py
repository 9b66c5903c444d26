"""Confidence intervals of a median. Python 3.11 or later, no packages."""

import math
import statistics


def bootstrap_interval(sample, generator, resamples=10_000):
    """Returns the 95 % percentile bootstrap interval of the median."""
    medians = sorted(statistics.median(generator.choices(sample, k=len(sample))) for _ in range(resamples))
    return medians[int(0.025 * resamples)], medians[int(0.975 * resamples) - 1]


def sign_interval(sample):
    """Returns the 95 % sign test interval of the median: never too narrow, often too wide."""
    ordered, n = sorted(sample), len(sample)
    out = tail = 0
    for k in range(n // 2):
        tail += math.comb(n, k)
        if tail > 0.025 * 2**n:
            break
        out = k
    return ordered[out], ordered[n - 1 - out]
