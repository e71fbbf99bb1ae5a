"""GrabCut from the tri-map (section 3.2).

Reference [18]: Rother, Kolmogorov and Blake, "GrabCut", SIGGRAPH 2004. Where the paper leaves a
choice we follow OpenCV, except that the graph covers the band alone and the mixtures start from the
known pixels.

Wood has the colour of skin and a shaded thigh that of the wall behind it; where colours mislead,
what is known of the person's place decides. Both sources are blurred: the detector's mask by its
resolution, a body by its error.

Known pixels are not nodes. A known pixel always stays on its own side, so its link to an open
neighbour is equivalent to a link from that neighbour to the known pixel's terminal (Boykov and
Jolly 2001). The band is a tenth to a third of the picture, and time grows with the nodes.
"""

from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from jaxtyping import Bool, Float, Int, UInt8

from fitter.arrays import GreyImage, Image, Mask
from fitter.errors import InvalidInputError
from fitter.observation.maps import window_about
from fitter.segmentation._band_kernels import link_band, mean_squared_difference
from fitter.segmentation._max_flow_kernels import SOURCE, maximum_flow, push_to_neighbours
from fitter.segmentation.colour_mixture import first_mixture, relearnt_mixture
from fitter.segmentation.trimap import Trimap, TrimapLabel, body_size, is_uncertain
from fitter.vocabulary.remarks import Note, Remark, remark

CUTS = 3
"""Borders move little after the third cut: over 28 tri-maps of seven rendered people the masks
overlap with the truth by 0.960, 0.962 and 0.963 after two, three and four. About the detector's
mask, whose border is sought in a narrow band, it is 0.970 after three and after four."""

CUTS_FROM_KNOWN = 1
"""Number of cuts that learn the colours from the known pixels alone.

OpenCV's GrabCut learns from the band at once, by its probable sides; background inside the first
body is then learnt as the person's colour, and the reverse. Over the same tri-maps and four cuts
the overlap is 0.963 with two such ones and 0.959 with none, and 0.953 if the mixtures are also
started with the band; OpenCV's is 0.954 to 0.959 depending on its random seed. About the detector's
mask one is as good as two (0.970)."""

LEARNT_EVERY = 4
"""Colours are learnt from every fourth pixel: the masks overlap with the truth as well as with all
of them (to 0.0001, for mixtures started with the band), in a quarter of the learning time."""

FIRST_LEARNT_EVERY = 4
"""The mixtures are first made from every fourth of these colours: they only start the others."""

SURROUNDINGS_SHARE = 0.15
"""Margin of sure background shown to GrabCut around the band, as a share of the band's longer side:
what has to be told from the skin is mostly the background next to the person, and the time grows
with the area."""

HOLE_SHARE = 0.002
"""Holes below this share of the person's area are speckle (a buckle, a highlight); larger ones are
real, such as the gap between arm and trunk."""

LEAST_CONTRAST = 0.01
"""Standard deviation of display values below which there is nothing to see: 8-bit rounding and
JPEG noise on a blank wall."""

DECIDED_SHARE = 0.02
"""If less than this share of the band went to one side, the colours did not tell the sides apart.
With a real person about half of the band goes to each."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Segmentation:
    """The observed silhouette.

    Attributes
    ----------
    mask
        (h, w) foreground.
    warnings
        What makes it doubtful.
    """

    mask: Mask
    warnings: tuple[Remark, ...]


def segment(display: Image, labels: Trimap, preferred: GreyImage | None = None) -> Segmentation:
    """Cut the person out of the picture.

    GrabCut sees only the surroundings of the band. Of its result, what is connected to the sure
    foreground is kept, with speckle holes filled.

    Parameters
    ----------
    display
        (h, w, 3) display values in [0, 1]: the colour distances GrabCut was made for.
    labels
        The tri-map.
    preferred
        (h, w) what is known of pixels beside their colours, nats in favour of the person
        (:mod:`fitter.segmentation.grabcut`); None is the paper's GrabCut.

    Raises
    ------
    InvalidInputError
        ``person-not-found`` if there is nothing to tell the person from.
    """
    if not (labels == TrimapLabel.FOREGROUND).any():
        reason = "No part of the person lies inside the picture."
        raise _no_person(reason)
    window = _window(labels)
    picture = cv2.convertScaleAbs(display[window], alpha=255.0)
    if cv2.meanStdDev(picture)[1].max() < 255.0 * LEAST_CONTRAST:
        reason = "The picture has one colour around the clicked points."
        raise _no_person(reason)
    mask = np.zeros(labels.shape, dtype=np.bool_)
    nats = np.zeros(labels.shape, np.float32) if preferred is None else preferred
    mask[window] = _foreground(picture, labels[window], nats[window])
    mask = _without_speckle(mask, labels == TrimapLabel.FOREGROUND)
    return Segmentation(mask=mask, warnings=(*_doubts(mask, labels), *border_warnings(mask)))


def border_warnings(mask: Mask) -> tuple[Remark, ...]:
    """Warns if the silhouette, found or sent, shows a body cut off by the picture's border."""
    cut = [
        side
        for side, line in (
            ("top", mask[0]),
            ("bottom", mask[-1]),
            ("left", mask[:, 0]),
            ("right", mask[:, -1]),
        )
        if line.any()
    ]
    if not cut:
        return ()
    return (
        remark(
            Note.BODY_OUTSIDE_PICTURE,
            f"The person reaches the {' and the '.join(cut)} border of the picture. What lies "
            "outside is inferred from the rest.",
        ),
    )


def _doubts(mask: Mask, labels: Trimap) -> tuple[Remark, ...]:
    band = mask[is_uncertain(labels)]
    if band.size == 0 or DECIDED_SHARE < band.mean() < 1.0 - DECIDED_SHARE:
        return ()
    return (
        remark(
            Note.SEGMENTATION_DOUBTFUL,
            "The person could not be told from the background by colour; the silhouette is "
            "little more than the first guess.",
        ),
    )


def _no_person(reason: str) -> InvalidInputError:
    return InvalidInputError(
        code="person-not-found",
        field="image",
        reason=reason,
        remedy="Check that the points lie on the person, or send a mask.",
    )


def _window(labels: Trimap) -> tuple[slice, slice]:
    """Rows and columns of everything but sure background, with a margin of it."""
    known = window_about(labels != TrimapLabel.BACKGROUND, margin=0)
    size = max(side.stop - side.start for side in known)
    return window_about(
        labels != TrimapLabel.BACKGROUND, margin=int(np.ceil(SURROUNDINGS_SHARE * size))
    )


def _foreground(picture: UInt8[np.ndarray, "h w 3"], labels: Trimap, preferred: GreyImage) -> Mask:
    """GrabCut: learn the colours of both sides, cut by colours and contrast, and repeat.

    Parameters
    ----------
    picture
        Display values in 8-bit steps.
    """
    known = [labels == TrimapLabel.BACKGROUND, labels == TrimapLabel.FOREGROUND]
    if not all(side.any() for side in known):
        # The person fills the picture: one side has no samples to learn from.
        return labels != TrimapLabel.BACKGROUND
    open_pixels = is_uncertain(labels)
    graph = BandGraph.of(picture, open_pixels, known[1])
    colours = picture.reshape(-1, 3)
    band = colours[np.flatnonzero(open_pixels)].astype(np.float32)
    known_colours = [
        colours[np.flatnonzero(side)[::LEARNT_EVERY]].astype(np.float32) for side in known
    ]
    band_colours = band[::LEARNT_EVERY]
    known_nats = preferred[open_pixels]
    mixtures = [first_mixture(colours[::FIRST_LEARNT_EVERY]) for colours in known_colours]
    taken = np.zeros(len(band), dtype=np.bool_)
    for cut in range(CUTS):
        colours = known_colours
        if cut >= CUTS_FROM_KNOWN:
            person = taken[::LEARNT_EVERY]
            band_sides = band_colours[~person], band_colours[person]
            colours = [np.concatenate(each) for each in zip(known_colours, band_sides, strict=True)]
        mixtures = [relearnt_mixture(*each) for each in zip(mixtures, colours, strict=True)]
        background, foreground = (mixture.costs(band) for mixture in mixtures)
        taken = graph.cut(background - foreground + known_nats)
    mask = known[1].copy()
    mask[open_pixels] = taken
    return mask


def _without_speckle(mask: Mask, sure: Mask) -> Mask:
    """Foreground that is connected to what is sure, without small holes."""
    if not mask.any():
        return mask
    whole, window = mask, window_about(mask, margin=1)
    mask, sure = mask[window], sure[window]
    count, found = cv2.connectedComponents(mask.astype(np.uint8), connectivity=8)
    regions = np.asarray(found, dtype=np.int32)
    kept = np.zeros(count, dtype=np.bool_)
    kept[regions[sure & mask]] = True
    mask = kept[regions]
    count, holes, statistics, _ = cv2.connectedComponentsWithStats(
        (~mask).astype(np.uint8), connectivity=4
    )
    small = statistics[:, cv2.CC_STAT_AREA] < HOLE_SHARE * mask.sum()
    small[0] = False
    whole = np.zeros_like(whole)
    whole[window] = mask | small[holes] if count > 1 else mask
    return whole


WEIGHT: Final = 16.0
"""Nats of preference per unit of log-odds. Much, because the contrast between two neighbours of the
same colour weighs gamma = 50 nats and errors of mask and body are shared by whole limbs. Chosen on
tuning halves: DECISIONS.md, "GrabCut is told where the person is"."""

BODY_BLUR_SHARE: Final = 0.006
"""Standard deviation of a fitted body's outline about the person's, as a share of the person's
longer side: a centimetre on a standing adult."""

_LEAST_SEEN, _LEAST_COVERED = 0.02, 0.05
"""No pixel is surer than this of being background or, mirrored, the person: of the detector's mask
and of a body."""


def preference(seed: GreyImage, silhouette: Mask | None) -> GreyImage:
    """Preference of each pixel to be the person, nats; negative for background.

    Parameters
    ----------
    seed
        (h, w) probability that a pixel shows the person, by the detector.
    silhouette
        (h, w) of a body fitted to the picture, if there is one yet.
    """
    nats = _log_odds(seed, _LEAST_SEEN)
    if silhouette is not None:
        sigma = BODY_BLUR_SHARE * body_size(silhouette, np.empty((0, 2, 2)))
        covered = cv2.GaussianBlur(silhouette.astype(np.float32), (0, 0), max(sigma, 0.5))
        nats = nats + _log_odds(covered, _LEAST_COVERED)
    return WEIGHT * nats


def _log_odds(probability: GreyImage, least: float) -> GreyImage:
    bounded = np.clip(probability, least, 1.0 - least)
    return np.log(bounded / (1.0 - bounded))


SMOOTHNESS = 50.0
"""GrabCut's gamma: the cost of a border between two pixels of the same colour, nats."""

STEPS_PER_NAT = 1000
"""Capacities are integers, so that sums are exact and saturated arcs exactly full."""

CERTAIN = 9.0 * SMOOTHNESS
"""A pixel's eight links together weigh at most 4 (1 + 1/sqrt(2)) gamma, so the cut does not change
once the difference between the pixel's two costs exceeds this."""


@dataclass(slots=True, eq=False, kw_only=True)
class BandGraph:
    """The residual graph after the flow so far. Mutable: cutting changes it.

    Attributes
    ----------
    heads, capacities
        (8 n,) see the kernels.
    bound
        (n,) links through known neighbours to the source, minus those to the sink.
    given, left
        (n,) preference for the source at the last cut, and what the flow left of it.
    """

    heads: Int[np.ndarray, " a"]
    capacities: Int[np.ndarray, " a"]
    bound: Int[np.ndarray, " n"]
    given: Int[np.ndarray, " n"]
    left: Int[np.ndarray, " n"]

    @classmethod
    def of(
        cls, picture: UInt8[np.ndarray, "h w 3"], open_pixels: Mask, foreground: Mask
    ) -> "BandGraph":
        """Link the open pixels of a picture; ``foreground`` gives the sides of the others.

        Two neighbours p and q are linked with weight gamma exp(-beta |z_p - z_q|²) / dist(p, q),
        where beta is the inverse of twice the mean of |z_p - z_q|² over the picture.
        """
        rows, columns = (each.astype(np.int32) for each in np.nonzero(open_pixels))
        nodes = np.full(open_pixels.shape, -1, dtype=np.int32)
        nodes[open_pixels] = np.arange(len(rows), dtype=np.int32)
        straight = _capacity_table(mean_squared_difference(picture))
        diagonal = np.rint(straight / np.sqrt(2.0)).astype(np.int32)
        heads, capacities, bound = link_band(
            picture, foreground, nodes, rows, columns, straight, diagonal
        )
        none = np.zeros(len(rows), dtype=np.int32)
        return cls(heads=heads, capacities=capacities, bound=bound, given=none, left=none.copy())

    def cut(self, preference: Float[np.ndarray, " n"]) -> Bool[np.ndarray, " n"]:
        """The open pixels on the foreground's side of the minimum cut.

        Only terminals change from cut to cut, so the previous flow is reused: the change is added
        to their residuals (Kohli and Torr 2005, section 3).

        Parameters
        ----------
        preference
            Cost of background minus cost of foreground, nats.
        """
        limited = np.clip(preference, -CERTAIN, CERTAIN)
        given = np.rint(STEPS_PER_NAT * limited).astype(np.int32) + self.bound
        self.left += given - self.given
        self.given = given
        push_to_neighbours(self.heads, self.capacities, self.left)
        return maximum_flow(self.heads, self.capacities, self.left) == SOURCE


def _capacity_table(mean_square: float) -> Int[np.ndarray, " d"]:
    """Capacity of a straight link by the squared difference, up to where it rounds to zero."""
    full = STEPS_PER_NAT * SMOOTHNESS
    beta = 0.5 / max(mean_square, np.finfo(np.float64).tiny)
    end = min(int(np.log(2.0 * full) / beta) + 1, 3 * 255**2 + 1)
    return np.rint(full * np.exp(-beta * np.arange(end))).astype(np.int32)
