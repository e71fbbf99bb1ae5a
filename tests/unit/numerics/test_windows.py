import numpy as np
import pytest

from fitter.numerics.masks import window_about


@pytest.mark.parametrize("margin", [0, 1, 30])
def test_a_window_holds_what_is_marked_and_a_margin_within_the_picture(margin):
    marked = np.zeros((20, 30), dtype=np.bool_)
    marked[4, 7] = marked[9, 12] = True
    window = window_about(marked, margin=margin)
    assert marked[window].sum() == 2
    rows, columns = np.arange(20)[window[0]], np.arange(30)[window[1]]
    assert (rows[0], rows[-1]) == (max(4 - margin, 0), min(9 + margin, 19))
    assert (columns[0], columns[-1]) == (max(7 - margin, 0), min(12 + margin, 29))
