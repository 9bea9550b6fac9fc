"""Letters of the pictures of a page, each drawn once for all of them: alone every picture brings its own alphabet."""

import re

# As Matplotlib defines a letter: an outline in the units of its font, scaled.
LETTER = re.compile(r'<path id="([^"]+)" d="([^"]*)" transform="scale\(0\.015625\)"/>\s*')
USE = re.compile(r'xlink:href="#([^"]+)"')


def shared_letters(html: str) -> str:
    """Return a page in which pictures that use the same letter use the same definition, that of the first of them."""
    numbers: dict[str, int] = {}  # by outline
    names: dict[str, str] = {}

    def defined(found: re.Match[str]) -> str:
        name, outline = found[1], found[2]
        known = outline in numbers
        number = numbers.setdefault(outline, len(numbers))
        names[name] = f"g{number}"
        return "" if known else found[0].replace(f'id="{name}"', f'id="g{number}"', 1)

    html = LETTER.sub(defined, html)
    return USE.sub(lambda found: f'href="#{names[found[1]]}"' if found[1] in names else found[0], html)
