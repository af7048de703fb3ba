"""The FEV viewer: terrain, water, edits and playback on the screen of a flood emergency manager.

Layers, from the top: cli > app > (gui | tools) > (net | render) > lod > world > (commands | errors).
Importing this package loads nothing heavy; import the layer that is needed.
"""
