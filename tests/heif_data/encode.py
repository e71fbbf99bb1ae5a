"""Encode the pictures next to this file: ``python -m tests.heif_data.encode``.

They are kept because encoders of HEVC are under the GPL: it needs ``pip install pillow-heif``.
"""

from pathlib import Path

import numpy as np
from PIL import Image

HERE = Path(__file__).parent
SAMPLE = HERE.parents[1] / "service" / "demo_data" / "sample.jpg"
WIDTH, HEIGHT = 96, 128
QUADRANTS = np.array(
    [[(200, 40, 40), (40, 180, 40)], [(40, 60, 200), (230, 230, 230)]], dtype=np.uint8
)
"""The colours top left, top right, bottom left and bottom right."""


def quadrants() -> np.ndarray:
    """A picture that shows how it has been turned."""
    return np.repeat(np.repeat(QUADRANTS, HEIGHT // 2, axis=0), WIDTH // 2, axis=1)


def main() -> None:
    """Write all files."""
    import pillow_heif  # pyright: ignore[reportMissingImports]

    pillow_heif.register_heif_opener()
    Image.fromarray(quadrants()).save(HERE / "eight_bits.heic", quality=60)
    ten_bits = (quadrants().astype(np.uint16) * 257).tobytes()
    pillow_heif.from_bytes(mode="RGB;16", size=(WIDTH, HEIGHT), data=ten_bits).save(
        HERE / "ten_bits.heic", quality=60
    )
    # As a phone's sensor sees who holds it upright.
    lying = np.rot90(np.asarray(Image.open(SAMPLE).convert("RGB")))
    Image.fromarray(lying).save(HERE / "sample_lying.heic", quality=40)


if __name__ == "__main__":
    main()
