// Paper B for Scilab's ode(), half period after half period: the equations of systems/triple.py.
// Before this file: p (constants), rtol, times (row). After it: states (6 x N), seconds.
function dx = rates(t, x)
    w = x(4:6);
    C = cos([x(1) - x(2), x(1) - x(3), x(2) - x(3)]) .* N;
    S = sin([x(1) - x(2), x(1) - x(3), x(2) - x(3)]) .* N;
    q = w.*w;
    r = [torque - S(1)*q(2) - S(2)*q(3); S(1)*q(1) - S(3)*q(3); S(2)*q(1) + S(3)*q(2)] ..
        - D*w - L.*sin(x(1:3));
    dx = [w; [p(1), C(1), C(2); C(1), p(2), C(3); C(2), C(3), p(3)] \ r];
endfunction

N = p(4:6); L = matrix(p(7:9), 3, 1);
D = [p(10) + p(11), -p(11), 0; -p(11), p(11) + p(12), -p(12); 0, -p(12), p(12)];
x = zeros(6, 1); t0 = times(1); states = zeros(6, length(times)); filled = 1; half = 0;
tic();
while filled < length(times)
    stop = (half + 1)/(2*p(14));
    torque = p(13)*(2*modulo(half, 2) - 1);
    ahead = times(filled + 1:$); ahead = ahead(ahead < stop);
    y = ode(x, t0, [ahead, stop], rtol, rtol/1000, rates);
    states(:, filled + 1:filled + length(ahead)) = y(:, 1:length(ahead));
    filled = filled + length(ahead);
    x = y(:, $); t0 = stop; half = half + 1;
end
seconds = toc();
