"""A module for each package: `lines(problem)` gives its methods."""
