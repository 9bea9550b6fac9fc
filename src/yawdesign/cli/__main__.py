"""``python -m yawdesign.cli``."""

from yawdesign.cli import main

if __name__ == "__main__":
    main()
