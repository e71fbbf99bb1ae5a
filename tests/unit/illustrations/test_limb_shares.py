"""What the page takes each vertex to be of."""

import numpy as np

from fitter.body.storage import load_body_model, packaged_model_path
from tests.illustrations.limb_shares import CHAINS, FILE, FULL, shares


def test_the_page_has_the_shares_of_the_packaged_models():
    assert FILE.read_bytes() == shares().tobytes()


def test_triangles_of_a_limb_follow_it():
    numbers, *parts = shares().astype(np.int64)
    model = load_body_model(packaged_model_path("male"))
    for number, chain in enumerate(CHAINS, 1):
        for part, levels in zip(chain, parts, strict=True):
            own = model.triangles[model.part_of_triangle == model.part_names.index(part)]
            of_part = np.where(numbers == number, levels, 0)[own].mean(axis=1)
            assert (of_part > FULL / 2).mean() > 0.9, part
