"""A stand-in for TI's tools, to see the image as a whole without them.

Which sections and symbols it has, about how large it is, how deep its stack gets. Sizes are estimates: code is compiled
for a Cortex-M3, whose instructions are half words and words as the C28x's are. No code for the C28x comes out of it.
"""
