// Paper A's appendix in Xcos: the diagram of its Figs 12 and 13, one evaluation, the whole fit.
// Before this file: file (where to store the diagram), measured (t, phi2), runs, iterations.
// It tells: "phi2 ANGLE ...", "evaluation SECONDS OF_THESE_IMPORTING CRITERION", "simplex EVALUATIONS
// ITERATIONS CRITERION SECONDS", and "done", after which Scilab may be ended: its own exit can hang.
//
// Blocks are Xcos' own, and those that the paper names: integrators, gains, expressions, conditional
// switches, sums, products, a sine, and a subsystem for each friction and each barrier; with zero
// crossings. The paper's figures show more than its text tells: constants and terminals may differ.
// The sign of the bearing's dry friction has no zero crossing, because the column rests on its pin for
// 0.2 ms at a rate of zero, where Xcos with it does not come to an end.
function [scs_m, at] = added(scs_m, block, exprs)
    block.graphics.exprs = exprs;
    scs_m.objs($ + 1) = block;
    at = length(scs_m.objs);
endfunction

function scs_m = wired(scs_m, from, to, kind)
    // from, to: [block, port]; kind 1 is a signal, -1 an activation
    scs_m.objs($ + 1) = scicos_link(xx=[0; 1], yy=[0; 0], ct=[1, kind], from=[from, 0], to=[to, 1]);
endfunction

function scs_m = joined(scs_m, from, to)
    // one output to the inputs to(k, :) = [block, port], through as many splits as it needs
    port = 1;
    for k = 1:size(to, 1) - 1
        scs_m.objs($ + 1) = SPLIT_f("define");
        split = length(scs_m.objs);
        scs_m.objs(split).model.out = [-1; -1];
        scs_m = wired(scs_m, [from, port], [split, 1], 1);
        scs_m = wired(scs_m, [split, 1], to(k, :), 1);
        from = split;
        port = 2;
    end
    scs_m = wired(scs_m, [from, port], to($, :), 1);
endfunction

function scs_m = sized(scs_m)
    // the ports that sums, products and subsystems will have once they are evaluated
    for at = 1:length(scs_m.objs)
        if or(scs_m.objs(at).gui == ["SUMMATION", "PRODUCT"]) then
            count = size(evstr(scs_m.objs(at).graphics.exprs($)), "*");
            scs_m.objs(at).model.in = -ones(count, 1);
            scs_m.objs(at).model.in2 = -2*ones(count, 1);
            scs_m.objs(at).model.intyp = ones(count, 1);
        elseif scs_m.objs(at).gui == "SUPER_f" then
            count = 0;
            for one = scs_m.objs(at).model.rpar.objs
                if typeof(one) == "Block" then count = count + (one.gui == "IN_f"); end
            end
            scs_m.objs(at).model.in = -ones(count, 1);
            scs_m.objs(at).model.in2 = -2*ones(count, 1);
            scs_m.objs(at).model.intyp = -ones(count, 1);
        end
    end
endfunction

function [scs_m, inside] = ported(count)
    // a diagram with so many inputs (blocks 1 to count) and one output (the next block)
    scs_m = scicos_diagram();
    for port = 1:count
        [scs_m, at] = added(scs_m, IN_f("define"), string(port));
        scs_m.objs(at).model.ipar = port;
    end
    [scs_m, inside] = added(scs_m, OUT_f("define"), "1");
endfunction

function block = subsystem(scs_m)
    block = SUPER_f("define");
    block.model.rpar = scs_m;
endfunction

function block = bearing_friction()
    // M_L, Eq 22: of the rate v1
    [scs_m, out] = ported(1);
    [scs_m, left] = added(scs_m, GAINBLK("define"), "Tvl");
    [scs_m, right] = added(scs_m, GAINBLK("define"), "Tvr");
    [scs_m, viscous] = added(scs_m, SWITCH2_m("define"), ["1"; "0"; "0"; "1"]);
    [scs_m, way] = added(scs_m, SIGNUM("define"), "0");
    [scs_m, dry] = added(scs_m, GAINBLK("define"), "Tb");
    [scs_m, total] = added(scs_m, SUMMATION("define"), ["1"; "[1;1]"]);
    scs_m = sized(scs_m);
    scs_m = joined(scs_m, 1, [left, 1; right, 1; viscous, 2; way, 1]);
    scs_m = joined(scs_m, left, [viscous, 1]);
    scs_m = joined(scs_m, right, [viscous, 3]);
    scs_m = joined(scs_m, way, [dry, 1]);
    scs_m = joined(scs_m, viscous, [total, 1]);
    scs_m = joined(scs_m, dry, [total, 2]);
    scs_m = joined(scs_m, total, [out, 1]);
    block = subsystem(scs_m);
endfunction

function block = plate_friction()
    // M_T, Eq 24: of the rate v2
    [scs_m, out] = ported(1);
    [scs_m, speed] = added(scs_m, ABS_VALUE("define"), "1");
    [scs_m, left] = added(scs_m, EXPRESSION("define"), ["1"; "Ts/(1+T0*u1)"; "0"]);
    [scs_m, right] = added(scs_m, EXPRESSION("define"), ["1"; "Tsr/(1+T0r*u1)"; "0"]);
    [scs_m, level] = added(scs_m, SWITCH2_m("define"), ["1"; "0"; "0"; "1"]);
    [scs_m, bump] = added(scs_m, EXPRESSION("define"), ["1"; "1+be/cosh(al*u1)"; "0"]);
    [scs_m, way] = added(scs_m, EXPRESSION("define"), ["1"; "tanh(al*u1)"; "0"]);
    [scs_m, total] = added(scs_m, PRODUCT("define"), "[1;1;1]");
    scs_m = sized(scs_m);
    scs_m = joined(scs_m, 1, [speed, 1; level, 2; bump, 1; way, 1]);
    scs_m = joined(scs_m, speed, [left, 1; right, 1]);
    scs_m = joined(scs_m, left, [level, 1]);
    scs_m = joined(scs_m, right, [level, 3]);
    scs_m = joined(scs_m, level, [total, 1]);
    scs_m = joined(scs_m, bump, [total, 2]);
    scs_m = joined(scs_m, way, [total, 3]);
    scs_m = joined(scs_m, total, [out, 1]);
    block = subsystem(scs_m);
endfunction

function block = barrier(limit, k, left, right)
    // R, Eqs 4 and 15: of the angle and its rate; damping is left or right of the middle
    [scs_m, out] = ported(2);
    [scs_m, d] = added(scs_m, EXPRESSION("define"), ["1"
        "(u1>=" + limit + ")*(u1-" + limit + ")+(u1<=-" + limit + ")*(u1+" + limit + ")"; "1"]);
    [scs_m, d_dot] = added(scs_m, EXPRESSION("define"), ["2"
        "((u1>=" + limit + ")+(u1<=-" + limit + "))*u2"; "1"]);
    [scs_m, stiffness] = added(scs_m, GAINBLK("define"), k);
    [scs_m, damping] = added(scs_m, EXPRESSION("define"), ["2"
        "((u1>=0)*" + left + "+(u1<0)*" + right + ")*u2"; "1"]);
    [scs_m, total] = added(scs_m, SUMMATION("define"), ["1"; "[1;1]"]);
    scs_m = sized(scs_m);
    scs_m = joined(scs_m, 1, [d, 1; d_dot, 1; damping, 1]);
    scs_m = joined(scs_m, 2, [d_dot, 2]);
    scs_m = joined(scs_m, d, [stiffness, 1]);
    scs_m = joined(scs_m, d_dot, [damping, 2]);
    scs_m = joined(scs_m, stiffness, [total, 1]);
    scs_m = joined(scs_m, damping, [total, 2]);
    scs_m = joined(scs_m, total, [out, 1]);
    block = subsystem(scs_m);
endfunction

function scs_m = pendulum()
    scs_m = scicos_diagram();
    scs_m.props.tf = 4.0001; // so that the sample at 4 s is taken
    scs_m.props.tol = [1e-6; 1e-6; 1e-10; 5; 0; 1; 0]; // Sundials/CVODE - BDF - Newton
    scs_m.props.context = [
        "al = 0.15; be = 2.2; Ts = 0.025; T0 = 0.5; Tsr = 0.045; T0r = 0.5;"
        "k2 = 0.7; c2l = 0.018; c2r = 0.02;"
        "B1 = 0.00135; B2 = 0.0003; A = 37.5*%pi/180; om = 3.9; ph = 120*%pi/180;"
        "k1l = 0.0135; k1r = 0.0203; k3l = 0.0243; k3r = 0.0365; Tvl = 0.0039; Tvr = 0.0049;"
        "Tb = 0.9*9.81*0.001126*0.008/2; k1 = 300; c1 = 120; s1 = 13.6*%pi/180; s2 = 1.1*%pi/180;"];
    free = ["0"; "0"; "1"; "-1"]; // no reset, no limits
    [scs_m, phi1] = added(scs_m, INTEGRAL_m("define"), ["-s1"; free]);
    [scs_m, v1] = added(scs_m, INTEGRAL_m("define"), ["0"; free]);
    [scs_m, phi2] = added(scs_m, INTEGRAL_m("define"), ["0"; free]);
    [scs_m, v2] = added(scs_m, INTEGRAL_m("define"), ["0"; free]);
    [scs_m, drive] = added(scs_m, GENSIN_f("define"), ["A"; "om"; "ph"]);
    [scs_m, slack] = added(scs_m, SUMMATION("define"), ["1"; "[1;-1]"]);
    [scs_m, left] = added(scs_m, EXPRESSION("define"), ["1"; "k1l*u1+k3l*u1*u1*u1"; "0"]);
    [scs_m, right] = added(scs_m, EXPRESSION("define"), ["1"; "k1r*u1+k3r*u1*u1*u1"; "0"]);
    [scs_m, spring] = added(scs_m, SWITCH2_m("define"), ["1"; "0"; "0"; "1"]);
    [scs_m, bearing] = added(scs_m, bearing_friction(), []);
    [scs_m, plate] = added(scs_m, plate_friction(), []);
    [scs_m, pin] = added(scs_m, barrier("s1", "k1", "c1", "c1"), []);
    [scs_m, beam] = added(scs_m, barrier("s2", "k2", "c2l", "c2r"), []);
    [scs_m, column] = added(scs_m, SUMMATION("define"), ["1"; "[1;-1;1;-1;1]"]);
    [scs_m, a1] = added(scs_m, GAINBLK("define"), "1/B1");
    [scs_m, disk] = added(scs_m, SUMMATION("define"), ["1"; "[-1;-1]"]);
    [scs_m, a3] = added(scs_m, GAINBLK("define"), "1/B2");
    [scs_m, a2] = added(scs_m, SUMMATION("define"), ["1"; "[1;-1]"]);
    [scs_m, out] = added(scs_m, TOWS_c("define"), ["1000"; "fivec"; "0"]);
    [scs_m, clock] = added(scs_m, SampleCLK("define"), ["0.01"; "0"]);
    scs_m = sized(scs_m);
    scs_m = joined(scs_m, drive, [slack, 1]);
    scs_m = joined(scs_m, slack, [left, 1; right, 1]);
    scs_m = joined(scs_m, left, [spring, 1]);
    scs_m = joined(scs_m, right, [spring, 3]);
    scs_m = joined(scs_m, phi1, [slack, 2; spring, 2; pin, 1]);
    scs_m = joined(scs_m, v1, [phi1, 1; bearing, 1; pin, 2]);
    scs_m = joined(scs_m, v2, [phi2, 1; plate, 1; beam, 2]);
    scs_m = joined(scs_m, phi2, [beam, 1; out, 1]);
    scs_m = joined(scs_m, spring, [column, 1]);
    scs_m = joined(scs_m, pin, [column, 2]);
    scs_m = joined(scs_m, beam, [column, 3; disk, 1]);
    scs_m = joined(scs_m, bearing, [column, 4]);
    scs_m = joined(scs_m, plate, [column, 5; disk, 2]);
    scs_m = joined(scs_m, column, [a1, 1]);
    scs_m = joined(scs_m, a1, [v1, 1; a2, 2]);
    scs_m = joined(scs_m, disk, [a3, 1]);
    scs_m = joined(scs_m, a3, [a2, 1]);
    scs_m = joined(scs_m, a2, [v2, 1]);
    scs_m = wired(scs_m, [clock, 1], [out, 1], -1);
endfunction

function y = sim_xcos_diag(u)
    // as printed in the appendix
    global importing phi2;
    before = toc();
    importXcosDiagram(file);
    importing = toc() - before;
    Context.al = u(1); Context.be = u(2); Context.Ts = u(3);
    Context.T0 = u(4); Context.Tsr = u(5); Context.T0r = u(6);
    Context.k2 = u(7); Context.c2l = u(8); Context.c2r = u(9);
    scicos_simulate(scs_m, Context);
    phi2 = fivec.values;
    y = mean((measured(:, 2) - phi2).^2)/2;
endfunction

loadXcosLibs();
loadScicos();
global importing phi2;
importing = 0;
xcosDiagramToScilab(file, pendulum());
begin = [0.15 2.2 0.025 0.5 0.045 0.5 0.7 0.018 0.02];
tic();
sim_xcos_diag(begin); // the first does not count
mprintf("phi2%s\n", strcat(msprintf(" %.12g\n", phi2)));
for k = 1:runs
    tic();
    y = sim_xcos_diag(begin);
    mprintf("evaluation %.9f %.9f %.17g\n", toc(), importing, y);
end
if iterations > 0 then
    options = optimset("MaxIter", iterations, "Display", "off");
    tic();
    [x, fval, exitflag, output] = fminsearch(sim_xcos_diag, begin, options);
    mprintf("simplex %d %d %.17g %.9f\n", output.funcCount, output.iterations, fval, toc());
end
mprintf("done\n");
exit
