"""GrabCut's definitions written plainly, and OpenCV's GrabCut, as references."""

import cv2
import numpy as np

from fitter.segmentation.colour_mixture import ColourMixture

GAMMA = 50.0
NEIGHBOURS = ((0, 1, 1.0), (1, 0, 1.0), (1, 1, np.sqrt(2.0)), (1, -1, np.sqrt(2.0)))
"""Half of the eight: row, column, distance."""


def paired(values: np.ndarray, row: int, column: int) -> tuple[np.ndarray, np.ndarray]:
    """Values at pixels and at their neighbours in a direction."""
    height, width = values.shape[:2]
    left, right = max(0, -column), width - max(0, column)
    return (
        values[: height - row, left:right],
        values[row:, left + column : right + column],
    )


def contrast(picture: np.ndarray) -> float:
    """beta of Rother et al., equation 5."""
    values = picture.astype(np.float64)
    squares = [
        ((here - there) ** 2).sum(axis=2).ravel()
        for here, there in (paired(values, row, column) for row, column, _ in NEIGHBOURS)
    ]
    return 0.5 / np.concatenate(squares).mean()


def border_cost(picture: np.ndarray, mask: np.ndarray) -> float:
    """V of Rother et al., equation 11, with OpenCV's division by the distance."""
    values, beta, total = picture.astype(np.float64), contrast(picture), 0.0
    for row, column, distance in NEIGHBOURS:
        here, there = paired(values, row, column)
        one, other = paired(mask, row, column)
        weights = GAMMA / distance * np.exp(-beta * ((here - there) ** 2).sum(axis=2))
        total += float(weights[one != other].sum())
    return total


def plain_costs(mixture: ColourMixture, colours: np.ndarray) -> np.ndarray:
    """Minus log density without the constant, component by component."""
    density = np.zeros(len(colours))
    for weight, mean, covariance in zip(
        mixture.weights, mixture.means, mixture.covariances, strict=True
    ):
        offset = colours - mean
        squared = np.einsum("si,ij,sj->s", offset, np.linalg.inv(covariance), offset)
        density += weight / np.sqrt(np.linalg.det(covariance)) * np.exp(-0.5 * squared)
    return -np.log(density)


def opencv_cut(
    picture: np.ndarray, labels: np.ndarray, background: ColourMixture, foreground: ColourMixture
) -> np.ndarray:
    """OpenCV's one cut with given colours."""
    states = labels.copy()
    models = _opencv_model(background), _opencv_model(foreground)
    cv2.grabCut(picture, states, (0, 0, 0, 0), *models, 1, cv2.GC_EVAL_FREEZE_MODEL)
    return (states & 1) == 1


def opencv_grabcut(picture: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """The whole of OpenCV's, from its own k-means."""
    states = labels.copy()
    models = np.zeros((1, 65)), np.zeros((1, 65))
    cv2.setRNGSeed(20090927)
    cv2.grabCut(picture, states, (0, 0, 0, 0), *models, 4, cv2.GC_INIT_WITH_MASK)
    return (states & 1) == 1


def _opencv_model(mixture: ColourMixture) -> np.ndarray:
    numbers = [mixture.weights, mixture.means.ravel(), mixture.covariances.ravel()]
    return np.concatenate(numbers)[None]
