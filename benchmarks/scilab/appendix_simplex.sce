// Scilab's fminsearch on the criterion of paper A's appendix, compiled from appendix.c.
// Before this file: library, measured (t, phi2), p (constants of torsion.h), iterations.
// It tells: "simplex EVALUATIONS ITERATIONS CRITERION SECONDS", and "done".
function y = criterion(u)
    y = call("appendix", u, 1, "d", p, 2, "d", phi2, 3, "d", count, 4, "d", last, 5, "d", ..
        1e-6, 6, "d", "out", [1, 1], 7, "d");
endfunction

link(library, "appendix", "c");
phi2 = measured(:, 2);
count = size(phi2, 1);
last = measured($, 1);
begin = [0.15 2.2 0.025 0.5 0.045 0.5 0.7 0.018 0.02];
options = optimset("MaxIter", iterations, "Display", "off");
tic();
[x, fval, exitflag, output] = fminsearch(criterion, begin, options);
mprintf("simplex %d %d %.17g %.9f\n", output.funcCount, output.iterations, fval, toc());
mprintf("done\n");
exit
