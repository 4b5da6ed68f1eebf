"""The names that other tools have for blocks: a table, and how a name is looked up in it."""

from __future__ import annotations

from collections.abc import Collection
from typing import Literal

from tracewire.library.sensor import SENSOR_TERMS

Tool = Literal["Simulink", "Modelica", "Xcos", ""]
"""Whose name it is; empty: a word that many use."""

NAMES: dict[str, dict[Tool, str]] = {
    "abs": {"Simulink": "Abs", "Xcos": "ABS_VALUE"},
    "and": {"Modelica": "And", "": "AND gate"},
    "band_pass": {"": "bandpass, band pass filter"},
    "belt": {"Simulink": "Belt Drive, Belt Pulley", "": "timing belt, toothed belt, pulleys"},
    "bouncing_body": {"": "bouncing ball, restitution"},
    "brake": {
        "Simulink": "Disc Brake, Drum Brake, Band Brake",
        "Modelica": "Brake",
        "": "disk brake, friction brake",
    },
    "clutch": {
        "Simulink": "Disk Friction Clutch",
        "Modelica": "Clutch",
        "": "friction clutch",
    },
    "compare": {
        "Simulink": "Relational Operator, Compare To Constant, Compare To Zero",
        "Modelica": "GreaterEqual, Greater, GreaterThreshold, Less, LessThreshold",
        "Xcos": "RELATIONALOP",
        "": "comparator, threshold, greater_than, less_than",
    },
    "chirp": {"Simulink": "Chirp Signal", "": "sweep, swept sine, sine sweep"},
    "constant": {"Modelica": "Const", "Xcos": "CONST, CONST_m, CONST_f"},
    "counter": {"Xcos": "Counter", "": "count, edge counter"},
    "coulomb": {"": "coulomb friction, karnopp"},
    "dead_zone": {"Simulink": "Dead Zone", "Xcos": "DEADBAND", "": "deadband"},
    "debounce": {"": "debouncer, glitch filter, contact bounce"},
    "delay": {
        "Simulink": "Transport Delay",
        "Modelica": "FixedDelay",
        "Xcos": "TIME_DELAY",
        "": "time delay, dead time, true delay",
    },
    "demux": {"Simulink": "Selector", "Modelica": "Extractor, DeMultiplex", "Xcos": "EXTRACTOR"},
    "derivative": {
        "Modelica": "Der",
        "Xcos": "DERIV",
        "": "differentiator, filtered derivative, washout, du/dt",
    },
    "discrete_integrator": {"Simulink": "Discrete-Time Integrator", "": "accumulator"},
    "discrete_pid": {"Simulink": "Discrete PID Controller", "": "digital PID, sampled PID"},
    "discrete_state_space": {"Modelica": "Discrete.StateSpace", "Xcos": "DLSS"},
    "discrete_transfer_function": {
        "Simulink": "Discrete Transfer Fcn, Discrete Filter, Discrete Zero-Pole",
        "Xcos": "DLR",
        "": "digital filter, IIR filter, FIR filter, z transfer function",
    },
    "divide": {"Simulink": "Divide", "Modelica": "Division", "Xcos": "INVBLK"},
    "dot": {"Simulink": "Dot Product", "": "inner product, scalar product"},
    "eddy_brake": {"": "eddy current brake, retarder"},
    "elastic_gear": {
        "Modelica": "ElastoBacklash, ElastoBacklash2, LossyGear",
        "": "gear_backlash, gear with play, lossy gear",
    },
    "edge": {
        "Simulink": "Detect Rise Positive, Detect Increase",
        "Modelica": "RisingEdge",
        "Xcos": "EDGE_TRIGGER",
        "": "edge detector, rising edge",
    },
    "expression": {
        "Simulink": "Fcn, MATLAB Function, Interpreted MATLAB Function",
        "Modelica": "RealExpression",
        "Xcos": "EXPRESSION",
        "": "formula, function, fcn",
    },
    "first_order": {"Modelica": "FirstOrder", "": "lag, PT1, first order lag, time constant"},
    "friction_table": {"": "friction map, friction curve, measured friction"},
    "gain": {"Modelica": "Gain", "Xcos": "GAINBLK, GAINBLK_f, GAIN_f", "": "amplifier, multiply"},
    "gear": {
        "Simulink": "Gear Box, Simple Gear",
        "Modelica": "IdealGear",
        "": "gearbox, transmission",
    },
    "hard_stop": {"": "end stop, mechanical stop"},
    "high_pass": {"": "highpass, high pass filter"},
    "integrator": {
        "Simulink": "Integrator",
        "Modelica": "Integrator",
        "Xcos": "INTEGRAL_m, INTEGRAL_f",
        "": "integral, integrate, 1/s",
    },
    "jk_flip_flop": {"Simulink": "J-K Flip-Flop", "Xcos": "JKFLIPFLOP"},
    "latch": {
        "Simulink": "S-R Flip-Flop, D Latch",
        "Modelica": "RSFlipFlop",
        "Xcos": "SRFLIPFLOP, DLATCH",
        "": "sr_flip_flop, rs_flip_flop, flip flop",
    },
    "lead_lag": {"Simulink": "Lead-Lag", "": "lead compensator, lag compensator, lead, PDT1"},
    "lever": {"Simulink": "Ideal Lever", "": "rocker, beam on a fulcrum"},
    "limited_integrator": {
        "Simulink": "Integrator Limited",
        "Modelica": "LimIntegrator",
        "": "saturated integrator",
    },
    "low_pass": {"Modelica": "Filter, LowpassButterworth", "": "lowpass, butterworth, filter"},
    "lookup_table_2d": {
        "Simulink": "2-D Lookup Table",
        "Modelica": "CombiTable2D, CombiTable2Ds",
        "Xcos": "INTRP2BLK_f",
        "": "map, characteristic map, bilinear, 2d table",
    },
    "mass": {"": "sliding mass, point mass, translational mass"},
    "matrix_gain": {"Simulink": "Matrix Gain", "Modelica": "MatrixGain", "Xcos": "MATMUL"},
    "max": {"Modelica": "Max", "Xcos": "MAX_f", "": "maximum"},
    "maxwell_element": {"": "generalised_maxwell_slip, GMS, generalized maxwell slip"},
    "maxwell_slip": {"": "iwan, masing, prandtl_ishlinskii, elasto-plastic"},
    "min": {"Modelica": "Min", "Xcos": "MIN_f", "": "minimum"},
    "mod": {"": "modulo, remainder"},
    "monostable": {"Simulink": "Monostable", "": "one shot, monoflop, pulse on edge"},
    "multisine": {"": "sum of sines, schroeder, harmonics"},
    "mux": {
        "Simulink": "Vector Concatenate",
        "Modelica": "Multiplex",
        "Xcos": "MUX, MUX_f, NRMSOM_f",
    },
    "noise": {
        "Simulink": "Band-Limited White Noise, Random Number",
        "Modelica": "NormalNoise, BandLimitedWhiteNoise",
        "Xcos": "RAND_m",
        "": "white noise, gaussian noise, normal noise, coloured noise, random, randn",
    },
    "not": {"Modelica": "Not", "": "NOT gate, inverter, negation"},
    "notch": {"": "notch filter, band stop, bandstop"},
    "or": {"Modelica": "Or", "": "OR gate"},
    "pid": {
        "Simulink": "PID Controller",
        "Modelica": "LimPID, PI, PD",
        "Xcos": "PID",
        "": "pid_controller, controller, pi controller, pd controller",
    },
    "pade_delay": {"Modelica": "PadeDelay", "": "pade"},
    "play_operator": {"": "gear play, hysteresis play"},
    "exp": {"Xcos": "EXPBLK_m"},
    "log": {"Xcos": "LOGBLK_f"},
    "relaxing_spring": {
        "": "maxwell model, zener, standard linear solid, viscoelastic, creep, rubber"
    },
    "sin": {"Xcos": "SINBLK_f"},
    "cos": {"Xcos": "COSBLK_f"},
    "tan": {"Xcos": "TANBLK_f"},
    "power": {"Xcos": "POWBLK, POWBLK_f", "": "pow, exponent"},
    "prbs": {"Simulink": "PN Sequence", "": "pseudo random binary sequence, random binary"},
    "product": {"Simulink": "Product", "Modelica": "Product", "Xcos": "PRODUCT, PROD_f"},
    "pulse": {
        "Simulink": "Pulse Generator",
        "Modelica": "Pulse",
        "Xcos": "PULSE_SC",
        "": "pulse train, PWM, rectangle",
    },
    "quantizer": {
        "Simulink": "Quantizer",
        "Xcos": "QUANT_f",
        "": "quantiser, quantise, round, ADC",
    },
    "rack": {
        "Simulink": "Rack & Pinion, Wheel and Axle",
        "Modelica": "IdealGearR2T, IdealRollingWheel",
        "": "rack and pinion, rolling wheel",
    },
    "ramp": {"Modelica": "Ramp", "Xcos": "RAMP"},
    "random_steps": {
        "Simulink": "Uniform Random Number",
        "Modelica": "UniformNoise",
        "": "uniform random, uniform noise, APRBS",
    },
    "rate_limiter": {
        "Simulink": "Rate Limiter",
        "Modelica": "SlewRateLimiter",
        "Xcos": "RATELIMITER",
        "": "slew rate, slew",
    },
    "relay": {
        "Modelica": "OnOffController",
        "Xcos": "HYSTHERESIS",
        "": "schmitt trigger, two point controller, thermostat, bang bang",
    },
    "reset_integrator": {"": "integrator with reset, resettable integrator"},
    "sample_and_hold": {
        "Simulink": "Sample and Hold, D Flip-Flop",
        "Modelica": "TriggeredSampler",
        "Xcos": "SAMPHOLD_m, DFLIPFLOP",
        "": "d_flip_flop, track and hold",
    },
    "rolling_resistance": {"": "rolling friction, tire resistance"},
    "rope": {"Simulink": "Rope", "": "cable, string, tension only"},
    "rotating_mass": {"": "flywheel, rotor, moment of inertia, rotational inertia, rotary load"},
    "saturation": {
        "Modelica": "Limiter, VariableLimiter",
        "Xcos": "SATURATION, SAT_f",
        "": "limit, limiter, clip, clamp, saturate",
    },
    "sawtooth": {
        "Simulink": "Repeating Sequence",
        "Modelica": "SawTooth",
        "Xcos": "SAWTOOTH_f",
    },
    "second_order": {"Modelica": "SecondOrder", "": "PT2, oscillator"},
    "select": {
        "Simulink": "Multiport Switch, Index Vector",
        "Xcos": "M_SWITCH, SELECT_m",
        "": "multiplexer, choose",
    },
    "sign": {"Modelica": "Sign", "Xcos": "SIGNUM", "": "signum, sgn"},
    "signal_builder": {
        "Simulink": "Signal Builder, Signal Editor",
        "Modelica": "TimeTable",
        "Xcos": "Sigbuilder",
        "": "piecewise_linear, time_table, profile",
    },
    "sine": {
        "Simulink": "Sine Wave, Signal Generator",
        "Modelica": "Sine",
        "Xcos": "GENSIN_f, GENSIN",
        "": "sinus, sin wave, cosine",
    },
    "solve": {"": "mass matrix, linear solve"},
    "spline_table": {"": "spline, cubic spline, spline interpolation"},
    "monotone_table": {"": "pchip, akima, monotone interpolation, smooth table"},
    "spring_damper": {
        "Simulink": "Torsional Spring-Damper",
        "Modelica": "SpringDamper",
        "": "kelvin voigt, spring and damper, shock absorber",
    },
    "square": {"Xcos": "GENSQR_f", "": "square wave"},
    "state_space": {
        "Simulink": "State-Space",
        "Modelica": "StateSpace",
        "Xcos": "CLSS",
        "": "ss, abcd",
    },
    "step": {"Xcos": "STEP_FUNCTION, STEP", "": "heaviside, jump"},
    "stribeck_friction": {
        "Simulink": "Rotational Friction, Translational Friction",
        "Modelica": "BearingFriction, SupportFriction",
        "": "stribeck curve, static friction, stiction",
    },
    "sum": {
        "Simulink": "Add, Subtract, Sum of Elements",
        "Modelica": "Add, Add3, Feedback, MultiSum",
        "Xcos": "SUMMATION, BIGSOM_f, SUM_f",
        "": "summer, adder, difference, plus, minus",
    },
    "switch": {"Xcos": "SWITCH2_m, SWITCH_f, RELAY_f", "": "if, conditional"},
    "table": {
        "Simulink": "1-D Lookup Table, From Workspace",
        "Modelica": "CombiTable1D, CombiTable1Ds, CombiTimeTable",
        "Xcos": "INTRPLBLK_f, LOOKUP_f, FROMWSB",
        "": "lookup_table, lookup, interpolation",
    },
    "time": {"Simulink": "Digital Clock", "Xcos": "TIME_f", "": "clock"},
    "timer": {"Modelica": "Timer", "": "stopwatch"},
    "toggle": {"Simulink": "T Flip-Flop", "": "t_flip_flop"},
    "total": {"": "sum of a vector"},
    "transfer_function": {
        "Simulink": "Transfer Fcn, Zero-Pole",
        "Modelica": "TransferFunction",
        "Xcos": "CLR",
        "": "tf, transfer, laplace, G(s)",
    },
    "triangle": {"": "triangular, triangle wave"},
    "unit_delay": {
        "Simulink": "Unit Delay",
        "Modelica": "UnitDelay",
        "Xcos": "DOLLAR_m, DOLLAR, DOLLAR_f, REGISTER",
        "": "z^-1, 1/z, one sample delay, delay_line",
    },
    "variable_delay": {
        "Simulink": "Variable Time Delay, Variable Transport Delay",
        "Modelica": "VariableDelay",
        "Xcos": "VARIABLE_DELAY",
    },
    "viscous": {"Modelica": "Damper", "": "damper, viscous friction, damping"},
    "stiffness": {"Modelica": "Spring", "": "spring"},
    "bias": {"": "constant force, constant torque, offset force"},
    "cogging": {"": "cogging torque, torque ripple, detent torque"},
    "cubic_stiffness": {"": "Duffing spring, hardening spring"},
    "elastic_load": {"": "tuned mass, attached resonator, flexible appendage"},
    "harmonic": {"": "sinusoidal force, periodic disturbance"},
    "overflow": {"": "weir, spillway"},
    "parametric": {"": "parametric stiffness, time-varying stiffness, Mathieu stiffness"},
    "quad_drag": {"": "quadratic drag, aerodynamic drag, air drag, turbulent drag"},
    "viscous_load": {"": "Lanchester damper, viscous absorber, second heat capacity, thermal mass"},
    "xor": {"Modelica": "Xor", "": "exclusive or, XOR gate"},
    "zero_order_hold": {
        "Modelica": "Sampler, ZeroOrderHold",
        "Xcos": "SAMPLEHOLD_m",
        "": "ZOH, sample, sampler, hold, DAC",
    },
}
"""The names of blocks in other tools, and other words for them, divided by commas.

Sources: the block libraries of Simulink R2023, of Modelica 4.0 and of Xcos 2023.
"""

SENSOR = "It is a number of a measured signal: signals: {{x: {{column: x, {0}: ...}}}}."
OTHERWISE: dict[str, str] = {
    "backlash": "The Backlash of Simulink and Xcos is 'play_operator' here, and teeth with play"
    " between two bodies are 'elastic_gear'.",
}
"""Blocks here that have the name of another one elsewhere, and what that is here."""
INSTEAD: dict[str, str] = {
    "logical operator, LOGICAL_OP, LOGIC, logic": "Use 'and', 'or', 'xor' or 'not'.",
    "MinMax, MAXMIN": "Use 'min' or 'max', which take two signals or more.",
    "CSCOPXY, CANIMXY, CSCOPXY3D, XY graph": (
        "'tracewire analyse portrait' draws one signal of a run over another."
    ),
    "scope, CSCOPE, CMSCOPE, CFSCOPE, CEVSCPE, AFFICH_m, TOWS_c, display,"
    " to workspace, plot, sink": (
        "A run keeps the signals that the section 'record' names; --figure draws them."
    ),
    "from file, inport, in, input, IN_f": (
        "Signals from outside stand in the section 'inputs', and a measured series binds them."
    ),
    "outport, out, output, OUT_f": (
        "A subsystem lists its signals in 'outputs'; at the top 'record' names what a run keeps."
    ),
    "CLOCK_c, CLKCINPUT, CEVENTSCOPE, MCLOCK_f, MFCLCK_f, M_freq, freq_div, EVTDLY_c, EVTVARDLY,"
    " sampleclk, VirtualCLK0": "A sampled block has its own 'period' and 'offset'.",
    "ANDBLK, ANDLOG_f, IFTHEL_f, ESELECT_f, EVTGEN_f, GENERAL_f, ZCROSS_f, NEGTOPOS_f, POSTONEG_f,"
    " zero crossing": (
        "Write an event: events: [{when: x > 1, set: {n: n + 1}}]; a block 'and' joins several."
    ),
    "HALT_f, ENDBLK, END_c, stop simulation": "The section 'span' says when a run ends.",
    "CONVERT, data type conversion": (
        "All signals are real numbers: leave it out. 'floor' and 'quantizer' round."
    ),
    "FROM, GOTO, GotoTagVisibility, FROMMO, GOTOMO": (
        "A wire is the name of a signal, which any block of the diagram may read: leave it out."
    ),
    "TEXT_f, annotation": "Write a comment behind #, or a 'label' of the block.",
    "bundle, bus, bus creator, bus selector": (
        "A vector is a 'mux'. A bundle of named signals is a subsystem that passes its inputs on:"
        " pose: {inputs: [x, v], outputs: {x: x, v: v}, blocks: {}} gives pose.x and pose.v."
    ),
    "READC_f, RFILE_f, READAU_f": (
        "Write a 'table' whose points stand in a file, or a measured series of an input."
    ),
    "WFILE_f, WRITEC_f, WRITEAU_f": "'tracewire run --output' writes a file of the signals.",
    "TRIGFUN": "Use 'sin', 'cos', 'tan' and so on, or an 'expression'.",
    "subsystem, superblock, SUPER_f": (
        "Define it in the section 'subsystems', and use its name as the type."
    ),
    "preisach": "Write include: tracewire:hysteresis.yaml, which has it as a subsystem.",
    "terminator, ground, TRASH_f": "A signal that nothing reads needs no block.",
    "sensor_lag, slow sensor": (
        "A sensor that answers late is a number of a measured signal, signals: {x: {column: x, "
        "delay: ...}}; one that follows slowly is a 'low_pass' of the signal, which is measured "
        "in its place."
    ),
    **{f"sensor_{name}": SENSOR.format(name) for name in SENSOR_TERMS},
}
"""What to do instead of what is no block here: its names, divided by commas, and a sentence."""


def find_synonym(name: str, known: Collection[str]) -> tuple[str, str] | None:
    """The block that another tool calls so, and a sentence that says it; None where there is none.

    known: the blocks that there are. Upper case, blanks and signs between words do not count.
    """
    wanted = plain(name)
    for block, tools in NAMES.items():
        for tool, names in tools.items():
            for other in names.split(", "):
                if plain(other) == wanted and block in known:
                    whose = f"{tool}'s {other}" if tool else f"'{other}'"
                    return block, f"{whose} is '{block}' here."
    same = next((block for block in known if plain(block) == wanted), None)
    return None if same is None else (same, f"'{name}' is '{same}' here.")


def find_instead(name: str) -> str:
    """What to use in the place of what is no block; empty where nothing is known."""
    wanted = plain(name)
    return next(
        (hint for names, hint in INSTEAD.items() if wanted in map(plain, names.split(", "))), ""
    )


def other_names(block: str) -> list[str]:
    """The names of a block elsewhere, each with the tool whose it is."""
    return [f"{names} ({tool})" if tool else names for tool, names in NAMES.get(block, {}).items()]


def plain(name: str) -> str:
    """A name without what differs between tools: case, blanks, signs, the word block."""
    letters = "".join(c for c in name.lower() if c.isalnum() or c in "/^().")
    return letters.removesuffix("block") or letters
