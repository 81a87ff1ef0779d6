"""`python -m stillspin` is the same as `stillspin`."""

from stillspin.cli import main

if __name__ == "__main__":
    main()
