"""Run the service's command line: `python -m solver_service`."""

from solver_service.cli import main

if __name__ == "__main__":
    main()
