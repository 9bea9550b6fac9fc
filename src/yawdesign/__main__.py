"""``python -m yawdesign``: the command line where the folder of programs is not on the path."""

from yawdesign.cli import main

if __name__ == "__main__":
    main()
