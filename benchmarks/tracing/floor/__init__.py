"""Records as real rigs give them: a hidden effect, and beside it what no model has.

The truth of every case has a small smooth force that is no block of the library (the floor), and
the record has the marks of a measurement: coloured noise, steps of an encoder, a filter, an
interpolation, jitter. Drives are sines, multisines, levels, and controllers.

`cases` says what is hidden where, `scenario` draws a rig, `sizes` its series and effects;
`choosing` mixes a floor that no law passes for, and `drawing` scales it and refuses what is no fair
case: refits (`refits`, on `windows`) of the truth and of the declared model, and of every other law
to first order (`rivals`). `measuring` writes down what an instrument shows, `units` the diagram.
All random numbers follow from the name, the draw and their purpose (`scenario.stream`).
"""
