% step.m: nanoseconds of a classic Runge-Kutta step of 1 ms of a generated right-hand side.
function step(name)
  slope = str2func(name);
  warm = 200;
  steps = 2000;
  y = zeros(numel(slope(0, zeros(8, 1))), 1);
  h = 1e-3;
  for i = 1:warm + steps
    if i == warm + 1
      begin = tic;
    end
    k1 = slope(0, y);
    k2 = slope(0, y + h/2*k1);
    k3 = slope(0, y + h/2*k2);
    k4 = slope(0, y + h*k3);
    y += h/6*(k1 + 2*k2 + 2*k3 + k4);
  end
  printf('%.6g\n', toc(begin)/steps*1e9);
end
