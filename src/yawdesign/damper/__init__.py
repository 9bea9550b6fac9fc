"""What to choose: curving limit, forward design, optimum."""
