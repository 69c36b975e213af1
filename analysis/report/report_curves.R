# Psychometric functions of staircases: the chance of a positive answer over the level,
#   guess + (1 - guess - lapse) Phi((x - threshold) / sigma),
# guess by the task, lapse free from none to a tenth; by maximum likelihood, intervals where the likelihood falls by half of
# chi-square's quantile (profiles over the other two), the deviance against parametric samples.

most_lapse <- 0.1

curve_chance <- function(par, x, guess) {
  z <- (x - par[1]) / exp(par[2])
  guess + (1 - guess - par[3]) * pnorm(z)
}

# Minus the logarithm of the likelihood, and its slopes by threshold, log sigma and lapse.
curve_loss <- function(par, x, k, n, guess) {
  p <- pmin(pmax(curve_chance(par, x, guess), 1e-12), 1 - 1e-12)
  -sum(k * log(p) + (n - k) * log1p(-p))
}

curve_slopes <- function(par, x, k, n, guess) {
  sigma <- exp(par[2])
  z <- (x - par[1]) / sigma
  p <- pmin(pmax(curve_chance(par, x, guess), 1e-12), 1 - 1e-12)
  by_p <- -(k / p - (n - k) / (1 - p))
  steep <- (1 - guess - par[3]) * dnorm(z)
  c(sum(by_p * -steep / sigma), sum(by_p * -steep * z), sum(by_p * -pnorm(z)))
}

# The best of several starts; `held`: which of the three stays at its value in `at`.
best_curve <- function(x, k, n, guess, starts, held = 0, at = NULL) {
  span <- max(diff(range(x)), 1e-9)
  low <- c(min(x) - span, log(span / 200), 0)
  high <- c(max(x) + span, log(span * 5), most_lapse)
  if (held > 0) low[held] <- high[held] <- at
  best <- NULL
  for (start in starts) {
    fit <- tryCatch(optim(pmin(pmax(start, low), high), curve_loss, curve_slopes, x, k, n, guess, method = "L-BFGS-B",
                          lower = low, upper = high, control = list(factr = 1e5, maxit = 200)), error = function(e) NULL)
    if (!is.null(fit) && (is.null(best) || fit$value < best$value)) best <- fit
  }
  best
}

# x: levels on the axis of the fit; k of n answers were positive there. `starts`: none: some over the levels.
fit_curve <- function(x, k, n, guess, starts = NULL) {
  span <- max(diff(range(x)), 1e-9)
  middle <- weighted.mean(x, n)
  if (is.null(starts)) starts <- list(c(middle, log(span / 4), 0.01), c(middle - span / 4, log(span / 10), 0.03),
                                      c(middle + span / 4, log(span / 2), 0.03))
  best <- best_curve(x, k, n, guess, starts)
  if (is.null(best)) return(NULL)
  p <- k / n
  entropy <- function(k, p) ifelse(k == 0, 0, k * log(p))
  list(par = best$par, loss = best$value, deviance = 2 * (best$value + sum(entropy(k, p) + entropy(n - k, 1 - p))))
}

# Where the likelihood is no longer within the interval, on both sides of parameter `which`; NA: nowhere near.
curve_bounds <- function(fit, x, k, n, guess, which) {
  span <- max(diff(range(x)), 1e-9)
  drop <- qchisq(0.95, 1) / 2
  step <- if (which == 1) span / 20 else 0.25
  vapply(c(-1, 1), function(side) {
    inside <- fit$par[which]
    so_far <- -drop
    start <- fit$par
    beyond <- function(at) {
      profile <- best_curve(x, k, n, guess, list(start), which, at)
      if (is.null(profile)) return(drop)
      start <<- profile$par
      profile$value - fit$loss - drop
    }
    for (i in 1:40) {
      outside <- inside + side * step
      if (which == 1 && (outside < min(x) - span || outside > max(x) + span)) return(NA)
      if (which == 2 && (outside < log(span / 200) || outside > log(span * 5))) return(NA)
      now <- beyond(outside)
      ends <- if (side < 0) c(now, so_far) else c(so_far, now)
      if (now > 0) return(uniroot(beyond, sort(c(inside, outside)), f.lower = ends[1], f.upper = ends[2],
                                  tol = 1e-4 * step)$root)
      inside <- outside
      so_far <- now
      step <- step * 1.3
    }
    NA
  }, 0)
}

# The share of samples of the fitted curve whose deviance is as large.
deviance_p <- function(fit, x, n, guess, samples = 100) {
  p <- curve_chance(fit$par, x, guess)
  drawn <- vapply(seq_len(samples), function(i) {
    k <- rbinom(length(x), n, p)
    again <- fit_curve(x, k, n, guess, list(fit$par))
    if (is.null(again)) NA else again$deviance
  }, 0)
  mean(c(TRUE, drawn >= fit$deviance - 1e-9), na.rm = TRUE)
}

# ---- Of a study ------------------------------------------------------------------------------------------------------

# Answers that count of the staircase's tracks.
answers_of <- function(rows) {
  its <- paste(rows$participant_id, rows$session) %in%
    paste(sessions$participant_id, sessions$session)[sessions$counted == 1]
  rows[its & rows$valid == 1 & !is.na(rows$positive) & !is.na(rows$track), ]
}

functions_of <- function(answers) unique(answers[c("participant_id", "condition")])

function_height <- function(answers) max(1, 0.3 + 1.75 * ceiling(nrow(functions_of(answers)) / 4))

# What the plan says of a staircase: its guess, its axis and unit.
staircase_of <- function(answers) {
  plans <- jsonlite::fromJSON("plan.json", simplifyVector = FALSE)$plans
  plan <- Filter(function(of) of$protocol_sha256 == answers$protocol_sha256[1], plans)[[1]]$plan
  staircase <- Filter(function(of) of$staircase == answers$staircase[1], plan$staircases)[[1]]
  told <- unlist(lapply(staircase$tracks, `[[`, "guess"))
  list(guess = if (length(told) > 0) told[1] else if (staircase$measure == "correct") 0.5 else 0,
       logarithmic = staircase$logarithmic, unit = staircase$unit)
}

show_functions <- function(id, answers, thresholds) computed(id %.% "curves", {
  if (nrow(answers) == 0) return(invisible())
  plan <- staircase_of(answers)
  shown <- functions_of(answers)
  several <- length(unique(shown$condition)) > 1
  of_level <- function(x) if (plan$logarithmic) 10^x else x
  set.seed(1)
  old <- panels(ceiling(nrow(shown) / 4), min(4, nrow(shown)), c(3, 3.2, 1.6, 0.4))
  on.exit(par(old))
  rows <- lapply(seq_len(nrow(shown)), function(i) {
    its <- answers[answers$participant_id == shown$participant_id[i] & answers$condition == shown$condition[i], ]
    levels <- sort(unique(its$level))
    x <- if (plan$logarithmic) log10(levels) else levels
    n <- as.vector(table(factor(its$level, levels)))
    k <- as.vector(tapply(its$positive, factor(its$level, levels), sum))
    fit <- if (length(levels) > 2) fit_curve(x, k, n, plan$guess)
    plot(x, k / n, ylim = c(0, 1), pch = 21, bg = "#1f5a8555", col = "#1f5a85", cex = 0.5 + 1.6 * sqrt(n / max(n)),
         xaxt = "n", xlab = "", ylab = "")
    at <- axTicks(1)
    axis(1, at, format(signif(of_level(at), 3), trim = TRUE, scientific = FALSE), cex.axis = 0.8)
    abline(h = plan$guess, col = "#999999", lty = 3)
    pane_title(paste0(shown$participant_id[i], if (several) paste0(", ", shown$condition[i])))
    who <- c(name(shown$participant_id[i]), if (several) name(shown$condition[i]))
    curve <- id %.% "curve" %.% i
    if (is.null(fit)) return(c(who, count(curve %.% "n", sum(n)), rep("", 7)))
    line <- seq(min(x), max(x), length.out = 100)
    lines(line, curve_chance(fit$par, line, plan$guess), col = "#b35900", lwd = 1.6)
    bounds <- of_level(curve_bounds(fit, x, k, n, plan$guess, 1))
    spread <- exp(curve_bounds(fit, x, k, n, plan$guess, 2))
    decimals <- decimals_of(diff(range(levels)), 3)
    c(who, count(curve %.% "n", sum(n)),
      num(curve %.% "threshold", of_level(fit$par[1]), decimals = decimals),
      interval(curve %.% "threshold", bounds[1], bounds[2], decimals),
      num(curve %.% "sigma", exp(fit$par[2])), interval(curve %.% "sigma", spread[1], spread[2]),
      num(curve %.% "lapse", fit$par[3], decimals = 3), num(curve %.% "deviance", fit$deviance),
      p_value(curve %.% "deviance_p", deviance_p(fit, x, n, plan$guess)))
  })
  para("Shares of positive answers, larger points for more of them, and the curve of each participant: guess ",
       name(format(plan$guess)), ", lapse free up to ", name("10 %"), ". Threshold: the middle of the curve",
       if (plan$unit != "") paste0(" [", name(plan$unit), "]"), "; sigma: its spread",
       if (plan$logarithmic) " in decades of the level", ", the smaller the steeper; ", percent,
       " intervals by likelihood ratio, an open end where there is none. Deviance: <i>p</i> by samples of the curve.",
       class = "note")
  html_table(c("Participant", if (several) "condition", "answers", "threshold", "interval", "sigma", "interval", "lapse",
               "deviance", "<i>p</i>"), rows, words = 1 + several, caption = "Psychometric functions")
})
