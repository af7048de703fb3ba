"""Run the viewer: `python -m viewer`."""

from viewer.cli import main

if __name__ == "__main__":
    main()
