# Computes the measures of trials of a peg in a hole again from the exported samples, by R's plain read.csv and the words
# of the codebook: Rscript measures_again.R EXPORT LEAVE_RADIUS_M ENGAGEMENT_DEPTH_M CLEARANCE_M. The bore's mouth is at the origin.
# Prints what differs by more than 1e-9 of its value and exits with 1 if anything does.
argument <- commandArgs(TRUE)
export <- argument[1]
leave <- as.numeric(argument[2])
engaged <- as.numeric(argument[3])
clearance <- as.numeric(argument[4])
rate <- 1000

lowpass <- function(x, corner = 10) {
  k <- tan(pi * corner / rate)
  d <- 1 + sqrt(2) * k + k^2
  b <- k^2 * c(1, 2, 1) / d
  a <- c(2 * (k^2 - 1), 1 - sqrt(2) * k + k^2) / d
  n <- length(x)
  pad <- min(n - 1, round(3 * rate / corner))
  y <- c(2 * x[1] - x[(pad + 1):2], x, 2 * x[n] - x[(n - 1):(n - pad)])
  for (pass in 1:2) {
    first <- y[1]
    driven <- b[1] * y + b[2] * c(first, head(y, -1)) + b[3] * c(first, first, head(y, -2))
    y <- rev(as.numeric(stats::filter(driven, -a, method = "recursive", init = c(first, first))))
  }
  y[pad + seq_len(n)]
}

turn <- function(q, r) {  # rotation vectors from the rows of q to those of r
  w <- rowSums(q * r)
  v <- q[, 1] * r[, 2:4] - r[, 1] * q[, 2:4] +
    cbind(q[, 3] * r[, 4] - q[, 4] * r[, 3], q[, 4] * r[, 2] - q[, 2] * r[, 4], q[, 2] * r[, 3] - q[, 3] * r[, 2])
  s <- sqrt(rowSums(v^2))
  angle <- 2 * atan2(s, abs(w)) * ifelse(w < 0, -1, 1)
  v * ifelse(s > 0, angle / s, 0)
}

sparc <- function(speed) {
  n <- 16 * 2^ceiling(log2(length(speed)))
  a <- Mod(fft(c(speed, rep(0, n - length(speed)))))[1:(floor(10 * n / rate) + 1)]
  a <- a / a[1]
  a <- a[1:max(which(a >= 0.05))]
  -sum(sqrt((1 / (length(a) - 1))^2 + diff(a)^2))
}

has <- function(status, bit) (status %/% 2^bit) %% 2 == 1
norm <- function(...) sqrt(Reduce(`+`, lapply(list(...), function(x) x^2)))
rank99 <- function(x) if (length(x) == 0) NA else sort(x)[ceiling(0.99 * length(x))]
mean_or_none <- function(x) if (length(x) == 0) NA else mean(x)
at_or_none <- function(i, t) if (length(i) == 0) NA else t[i[1]]

measures <- function(s, row) {
  s <- s[s$tick >= row$start_tick & s$tick <= row$end_tick, ]
  t <- s$t_s - s$t_s[1]
  n <- nrow(s)
  k <- s$tick < row$end_tick  # trial ticks
  last <- c(s$periods[-1], 1) / rate
  f <- norm(s$force_x_N, s$force_y_N, s$force_z_N)
  m <- norm(s$torque_x_Nm, s$torque_y_Nm, s$torque_z_Nm)
  touch <- k & (s$contacts > 0 | ((f > 1e-6 | m > 1e-9) & !has(s$status, 20) & !has(s$status, 21)) |
                  (has(s$status, 17) & s$hand_depth_m > 0))
  inside <- s$proxy_z_m <= 0 & norm(s$proxy_x_m, s$proxy_y_m) <= clearance + 0.0002
  depth <- ifelse(inside, -s$proxy_z_m, NA)
  x <- as.matrix(s[c("hand_x_m", "hand_y_m", "hand_z_m")])
  q <- as.matrix(s[c("hand_qw", "hand_qx", "hand_qy", "hand_qz")])
  q <- q / sqrt(rowSums(q^2))
  for (i in seq_len(n)[-1]) if (sum(q[i, ] * q[i - 1, ]) < 0) q[i, ] <- -q[i, ]
  y <- apply(x, 2, lowpass)
  p <- apply(q, 2, lowpass)
  p <- p / sqrt(rowSums(p^2))
  step <- diff(y)
  way <- sqrt(rowSums(step^2))
  spin <- turn(p[-n, , drop = FALSE], p[-1, , drop = FALSE])
  jerk <- sum(diff(y, differences = 3)^2) * rate^5
  time <- t[n]
  noise <- 20 * 2 * (2 * pi)^6 * 10^7 / rate * gamma(1.75) * gamma(0.25) / 4 * time * mean(rowSums((x - y)^2))
  left <- which(k & sqrt(rowSums(sweep(x, 2, x[1, ])^2)) > leave)
  first_touch <- at_or_none(which(touch), t)
  engagement <- at_or_none(which(k & !is.na(depth) & depth >= engaged), t)
  approach <- if (is.na(engagement)) first_touch else min(first_touch, engagement, na.rm = TRUE)
  done <- row$outcome == "success"
  in_touch <- which(touch)
  c(success = as.numeric(done), trial_time_s = time, time_s = time, finished = as.numeric(done),
    completion_time_s = if (done) time - at_or_none(left, t) else NA,
    approach_time_s = approach, search_time_s = engagement - approach,
    insertion_time_s = if (done) time - engagement else NA,
    insertion_depth_m = if (is.na(depth[n])) 0 else depth[n],
    path_length_m = sum(way), straight_path_ratio = sum(way) / sqrt(sum((y[n, ] - y[1, ])^2)),
    rotation_path_rad = sum(sqrt(rowSums(spin^2))), spectral_arc_length = sparc(way * rate),
    log_dimensionless_jerk = if (jerk >= noise) -log(time^3 / max(way * rate)^2 * jerk) else NA,
    contact_onsets = sum(diff(c(-1000, round(rate * t[in_touch]))) > 20),
    contact_time_s = sum(last[touch]), contact_time_outside_s = sum(last[touch & !inside]),
    mean_force_N = mean_or_none(f[touch]), p99_force_N = rank99(f[touch]), peak_force_N = max(f[k]),
    mean_torque_Nm = mean_or_none(m[touch]), p99_torque_Nm = rank99(m[touch]), peak_torque_Nm = max(m[k]),
    mean_hand_depth_m = mean_or_none(s$hand_depth_m[touch]), p99_hand_depth_m = rank99(s$hand_depth_m[touch]),
    max_hand_depth_m = max(s$hand_depth_m[k]),
    mean_proxy_depth_m = mean_or_none(s$proxy_depth_m[touch]), p99_proxy_depth_m = rank99(s$proxy_depth_m[touch]),
    max_proxy_depth_m = max(s$proxy_depth_m[k]),
    min_proxy_gap_m = if (all(is.na(s$proxy_gap_m[k]))) NA else min(s$proxy_gap_m[k], na.rm = TRUE),
    impulse_Ns = sum(f[k] * last[k]),
    work_J = -sum(as.matrix(s[c("force_x_N", "force_y_N", "force_z_N")])[-n, ] * step) -
      sum(as.matrix(s[c("torque_x_Nm", "torque_y_Nm", "torque_z_Nm")])[-n, ] * spin),
    saturated_share = mean(has(s$status[k], 4)))
}

trials <- read.csv(file.path(export, "trials.csv"))
compared <- 0
failed <- 0
for (i in seq_len(nrow(trials))) {
  row <- trials[i, ]
  if (is.na(row$start_tick)) next
  file <- sprintf("samples/%s_%d_t%03d_a%d.csv.gz", row$participant_id, row$session, row$trial_index, row$attempt_no)
  again <- measures(read.csv(gzfile(file.path(export, file))), row)
  for (name in names(again)) {
    told <- row[[name]]
    compared <- compared + 1
    same <- if (is.na(told) || is.na(again[[name]])) is.na(told) && is.na(again[[name]]) else
      abs(told - again[[name]]) <= 1e-9 * max(abs(told), 1e-3)
    if (!same) {
      failed <- failed + 1
      cat(file, name, "exported", format(told, digits = 17), "again", format(again[[name]], digits = 17), "\n")
    }
  }
}
cat("compared", compared, "values,", failed, "differ\n")
quit(status = if (failed > 0 || compared == 0) 1 else 0)
