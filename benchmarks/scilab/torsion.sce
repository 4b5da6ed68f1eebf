// Paper A for Scilab's ode("root"): the equations of systems/torsion.py, in an order that is fast.
// Before this file: p (constants), rtol, times (row). After it: states (4 x N), seconds.
function [column, disk] = torques(t, x)
    phi_f = p(3)*sin(p(4)*t + p(5)) - x(1);
    column = phi_f*(kappa1 + kappa2*phi_f*phi_f);
    z = p(17)*x(4);
    M_T = level/(1 + decay*x(4))*(1 + p(18)/cosh(z))*tanh(z);
    disk = -M_T;
    if m(1) <> 0 then column = column - p(19)*(x(1) - m(1)*p(24)) - p(20)*x(2); end
    if m(2) <> 0 then disk = disk - p(21)*(x(3) - m(2)*p(25)) - c2*x(4); end
    column = column - disk;
endfunction

function dx = rates(t, x)
    [column, disk] = torques(t, x);
    a = 0;
    if m(4) <> 0 then a = (column - viscous*x(2) - m(4)*p(12))/p(1); end
    dx = [x(2); a; x(4); disk/p(2) - a];
endfunction

function g = margins(t, x)
    g = ones(8, 1);
    if m(1) <> 0 then g(1) = m(1)*x(1) - p(24);
    else g(1) = p(24) - x(1); g(2) = p(24) + x(1); g(3) = m(3)*x(1); end
    if m(2) <> 0 then g(4) = m(2)*x(3) - p(25);
    else g(4) = p(25) - x(3); g(5) = p(25) + x(3); end
    g(6) = m(5)*x(4);
    if m(4) <> 0 then g(7) = m(4)*x(2);
    else column = torques(t, x); g(7) = p(12) - column; g(8) = p(12) + column; end
    if t == t0 then g = max(g, 1e-300); end // a zero at a segment's start does not fire
endfunction

function [kappa1, kappa2, level, decay, c2, viscous] = chosen(m)
    kappa1 = p(7); kappa2 = p(9); level = p(14); decay = -p(16); c2 = p(23); viscous = p(11);
    if m(3) > 0 then kappa1 = p(6); kappa2 = p(8); end
    if m(5) > 0 then level = p(13); decay = p(15); end
    if m(2) > 0 then c2 = p(22); end
    if m(4) > 0 then viscous = p(10); end
endfunction

function [x, m] = happen(t, x, m, which)
    select which
    case 1 then if m(1) <> 0 then x(1) = m(1)*p(24); m(1) = 0; else x(1) = p(24); m(1) = 1; end
    case 2 then x(1) = -p(24); m(1) = -1;
    case 3 then x(1) = 0; m(3) = -m(3);
    case 4 then if m(2) <> 0 then x(3) = m(2)*p(25); m(2) = 0; else x(3) = p(25); m(2) = 1; end
    case 5 then x(3) = -p(25); m(2) = -1;
    case 6 then
        x(4) = 0; dx = rates(t, x);
        if dx(4) <> 0 then m(5) = sign(dx(4)); else m(5) = -m(5); end
    else
        if m(4) <> 0 then
            x(2) = 0; column = torques(t, x);
            if abs(column) <= p(12) then m(4) = 0; else m(4) = sign(column); end
        elseif which == 7 then m(4) = 1; else m(4) = -1; end
    end
endfunction

m = [0 0 -1 1 -1]; x = [-p(24); 0; 0; 0]; t0 = times(1); t1 = times($);
states = zeros(4, length(times)); states(:, 1) = x; filled = 1;
tic();
while filled < length(times)
    [kappa1, kappa2, level, decay, c2, viscous] = chosen(m);
    ahead = times(filled + 1:$);
    [y, rd] = ode("root", x, t0, ahead, rtol, rtol/1000, rates, 8, margins);
    if rd <> [] then
        reached = sum(ahead < rd(1));
    else
        reached = size(y, 2);
    end
    states(:, filled + 1:filled + reached) = y(1:4, 1:reached);
    filled = filled + reached;
    if rd == [] then break; end
    t0 = rd(1);
    [x, m] = happen(t0, y(1:4, $), m, rd(2));
end
seconds = toc();
