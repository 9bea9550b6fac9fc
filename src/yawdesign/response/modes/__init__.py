"""The modes of a vehicle: names, shapes, and how they move along a parameter."""
