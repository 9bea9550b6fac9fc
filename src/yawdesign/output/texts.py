"""Texts of the user in files of other programs."""


def printable(text: str) -> str:
    r"""Return a text on one line, with a blank for each character that cannot be printed.

    Examples
    --------
    >>> printable("a\tbogie\x07, µ = 0.3")
    'a bogie , µ = 0.3'
    """
    return "".join(char if char.isprintable() else " " for char in text)
