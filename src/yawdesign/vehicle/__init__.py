"""The physics: elements, their assembly, the characteristic polynomial."""
