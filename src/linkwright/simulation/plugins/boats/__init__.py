"""Plugins for boats: waves, hulls that float on them, and wind on the parts above the water."""
