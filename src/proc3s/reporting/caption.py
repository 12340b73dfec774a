"""A sentence below a picture."""

from importlib.util import find_spec
from pathlib import Path
from textwrap import wrap

from proc3s.sandbox.text import clean

SIZE, MARGIN = 14, 8
"""Of the letters, and of the room around them, pixels."""
LONGEST = 400
"""Characters that are shown."""


def write_below(picture: Path, text: str) -> None:
    """Add a sentence to a PNG file, on a white strip below what it shows."""
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.truetype(str(_font()), SIZE)
    with Image.open(picture) as opened:
        image = opened.convert("RGB")
    letters = int((image.width - 2 * MARGIN) / (0.62 * SIZE))
    lines = "\n".join(wrap(clean(text, LONGEST), max(letters, 1)))
    _, _, _, height = ImageDraw.Draw(image).multiline_textbbox((0, 0), lines, font=font)
    whole = Image.new("RGB", (image.width, image.height + int(height) + 2 * MARGIN), "white")
    whole.paste(image)
    ImageDraw.Draw(whole).multiline_text((MARGIN, image.height + MARGIN), lines, "firebrick", font=font)
    whole.save(picture)


def _font() -> Path:
    """The font of matplotlib's pictures, found without its import, which takes long."""
    found = find_spec("matplotlib")
    assert found
    assert found.origin
    return Path(found.origin).parent / "mpl-data/fonts/ttf/DejaVuSans.ttf"
