"""The solver service of FEV: computes floods, keeps them, and streams them to viewers."""
