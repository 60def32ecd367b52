% check.m: the files of `whirl derive --as octave` under ode45 against the records of `whirl run`.
%
% Runs in a folder that holds, for each scene below, NAME.m (the generated function), NAME_as_is.m
% (the commands in its own comments) and whirl_NAME.txt (written by `whirl run --columns`). Solver,
% tolerances and time spans are those of the dissertation's appendices B to F. Prints a table; exits
% with 1 when a bound is exceeded.
%
% Pointwise: the largest difference of any coordinate or rate, relative to the largest magnitude of
% that column, up to the time until which two integrators can agree at these tolerances. For the
% chaotic Thomson device that is a part of the run; what must hold to its end are the invariants.
1;

function cases = list_cases()
  fine = odeset('RelTol', 1e-7, 'AbsTol', 1e-9);             % appendices B, C, E, F
  gear = odeset('RelTol', 1e-5, 'AbsTol', 1e-7, 'MaxStep', 0.002);  % appendix D
  none = @(Y) zeros(size(Y, 1), 1);
  r = 0.3;
  % Centres of mass, from the geometry and not from the scenes' outputs.
  gear_cm = @(Y) Y(:, 2) + r*cos(Y(:, 1));
  thomson_cm = @(Y) Y(:, 3) + r*(4*cos(Y(:, 1)) + cos(2*Y(:, 1)) + cos(Y(:, 2)))/3;
  % Relative to what the motor gave: its work is torque times angle, the rest is kinetic energy.
  gear_energy = @(Y) energy_gap(gear_kinetic(Y), 2*Y(:, 1));
  hinge_energy = @(Y) energy_gap(hinge_kinetic(Y), -2*Y(:, 1));
  thomson_energy = @(Y) energy_gap(thomson_kinetic(Y), -2*Y(:, 1));
  % Bounds, each far above what is found and far below what a wrong term does: differences, ten times
  % the relative tolerance for the linear masses, a thousand times where a swing or chaos lets errors
  % grow; centre of mass, a thousandth of its way on the carriage; energy, a thousand times the tolerance.
  %        scene                    n  options until bound  centre of mass     energy
  cases = {
    'two_mass_absolute',      4, fine,  5, 1e-6,  none,       0,     none,           0;
    'two_mass_relative',      4, fine,  5, 1e-6,  none,       0,     none,           0;
    'epicyclic_from_rest',    4, gear,  9, 1e-8,  gear_cm,    1e-8,  gear_energy,    1e-8;
    'driven_hinge_from_rest', 4, fine, 10, 1e-4,  none,       0,     hinge_energy,   1e-5;
    'thomson_a',              6, fine,  8, 1e-4,  thomson_cm, 1e-4,  thomson_energy, 1e-5;
    'thomson_b',              6, fine,  2, 1e-4,  thomson_cm, 1e-4,  thomson_energy, 1e-5;
  };
end

function gap = energy_gap(kinetic, work)
  gap = (kinetic - kinetic(1) - work + work(1)) ./ max(abs(kinetic));
end

function T = gear_kinetic(Y)
  m = 2; r = 0.3; I = m*r^2/2;
  vx = Y(:, 4) - 2*r*Y(:, 3).*sin(Y(:, 1));
  vy = 2*r*Y(:, 3).*cos(Y(:, 1));
  T = m*Y(:, 4).^2/2 + m*(vx.^2 + vy.^2)/2 + I*(2*Y(:, 3)).^2/2;
end

function T = hinge_kinetic(Y)
  m = 2; r = 0.3; I = m*r^2/2;
  vx = -r*Y(:, 3).*sin(Y(:, 1)) - r*Y(:, 4).*sin(Y(:, 2));
  vy = r*Y(:, 3).*cos(Y(:, 1)) + r*Y(:, 4).*cos(Y(:, 2));
  T = m*(vx.^2 + vy.^2)/2 + I*Y(:, 4).^2/2;
end

function T = thomson_kinetic(Y)
  m = 2; r = 0.3; I = m*r^2/2;
  s1 = sin(Y(:, 1)); c1 = cos(Y(:, 1));
  bx = Y(:, 6) - 2*r*Y(:, 4).*s1;
  by = 2*r*Y(:, 4).*c1;
  dx = bx - 2*r*Y(:, 4).*sin(2*Y(:, 1)) - r*Y(:, 5).*sin(Y(:, 2));
  dy = by + 2*r*Y(:, 4).*cos(2*Y(:, 1)) + r*Y(:, 5).*cos(Y(:, 2));
  T = m*Y(:, 6).^2/2 + m*(bx.^2 + by.^2)/2 + I*(2*Y(:, 4)).^2/2 + m*(dx.^2 + dy.^2)/2;
end

% The commands in the generated file's comments: they run, and leave the table K = [T Y] that loads.
function check_as_is(name, n, until_s)
  evalc([name '_as_is']);
  K = load([name '.txt']);
  if size(K, 2) != n + 1 || size(K, 1) < 10 || abs(K(end, 1) - until_s) > 1e-9
    error('%s: the table K = [T Y] is %d by %d and ends at %g', name, size(K), K(end, 1));
  end
end

function ok = check_case(name, n, options, until_s, bound, cm, cm_bound, energy, energy_bound)
  W = load(['whirl_' name '.txt']);
  t = W(:, 1);
  tic;
  [T, Y] = ode45(str2func(name), t, W(1, 2:n + 1)', options);
  spent_s = toc;
  check_as_is(name, n, t(end));
  part = t <= until_s + 1e-9;
  difference = max(max(abs(Y(part, :) - W(part, 2:n + 1))) ./ max(abs(W(part, 2:n + 1))));
  at_end = max(max(abs(Y - W(:, 2:n + 1))) ./ max(abs(W(:, 2:n + 1))));
  x = cm(Y);
  cm_drift = max(abs(x - x(1)));
  x = cm(W(:, 2:n + 1));
  whirl_drift = max(abs(x - x(1)));
  gap = max(abs(energy(Y)));
  whirl_gap = max(abs(energy(W(:, 2:n + 1))));
  ok = difference <= bound && cm_drift <= cm_bound && whirl_drift <= cm_bound && ...
       gap <= energy_bound && whirl_gap <= energy_bound;
  words = {'TOO LARGE', 'ok'};
  printf('%-23s %3g s  %8.1e (%6.0e)  %8.1e  %8.1e %8.1e (%6.0e)  %8.1e %8.1e (%6.0e)  %5.1f s  %s\n', ...
         name, until_s, difference, bound, at_end, cm_drift, whirl_drift, cm_bound, gap, whirl_gap, ...
         energy_bound, spent_s, words{ok + 1});
end

printf('%-23s %5s  %-17s  %-8s  %-26s  %-26s  %s\n', '', '', 'difference, rel.', 'to the', ...
       'centre of mass moves [m]', 'energy gap, relative', 'ode45');
printf('%-23s %5s  %8s %8s  %8s  %8s %8s %8s  %8s %8s %8s  %s\n', 'scene', 'until', 'found', ...
       'bound', 'end', 'ode45', 'whirl', 'bound', 'ode45', 'whirl', 'bound', 'takes');
cases = list_cases();
passed = 0;
for i = 1:size(cases, 1)
  passed += check_case(cases{i, :});
end
printf('%d passed, %d failed\n', passed, size(cases, 1) - passed);
exit(passed != size(cases, 1));
