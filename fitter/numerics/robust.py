"""Robust functions."""

import numpy as np
from jaxtyping import Float


def geman_mcclure(residuals: Float[np.ndarray, "..."], scale: float) -> Float[np.ndarray, "..."]:
    """ρ_η(x) = x² / (η² + x²), in [0, 1) (section 5, [11])."""
    squared = residuals * residuals
    return squared / (scale * scale + squared)


def geman_mcclure_weights(
    residuals: Float[np.ndarray, "..."], scale: float
) -> Float[np.ndarray, "..."]:
    """Weights w with w x = ρ'_η(x): w = 2 η² / (η² + x²)²."""
    total = scale * scale + residuals * residuals
    return 2.0 * scale * scale / (total * total)


def huber_weights(
    residuals: Float[np.ndarray, "..."], threshold: float
) -> Float[np.ndarray, "..."]:
    """Weights w with w x = the derivative of Huber's function: 1 inside, threshold/|x| outside."""
    return threshold / np.maximum(np.abs(residuals), threshold)


def huber(residuals: Float[np.ndarray, "..."], threshold: float) -> Float[np.ndarray, "..."]:
    """Huber's function: x²/2 within the threshold, linear beyond."""
    size = np.abs(residuals)
    return np.where(size <= threshold, 0.5 * size * size, threshold * (size - 0.5 * threshold))


def boundary_loss(residuals: Float[np.ndarray, "..."], scale: float) -> Float[np.ndarray, "..."]:
    """½ x² / (1 + x²/η²): Geman and McClure's function with unit curvature at zero."""
    squared = residuals * residuals
    return 0.5 * squared / (1.0 + squared / (scale * scale))


def boundary_weights(residuals: Float[np.ndarray, "..."], scale: float) -> Float[np.ndarray, "..."]:
    """Weights w with w x = the derivative of :func:`boundary_loss`."""
    damping = 1.0 + (residuals / scale) ** 2
    return 1.0 / (damping * damping)
