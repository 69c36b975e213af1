# Rscript report_models.R FOLDER OBSERVERS: what the folder's texts compute of data that are drawn here, beside what follows
# from definitions. OBSERVERS: of psychometric functions, for each setting.
# Truth: the likelihood of the ordinal model integrated on a grid and climbed by optim(); the t statistics of equivalence
# written out; power as a share of drawn F; observers whose function is known.
arguments <- commandArgs(trailingOnly = TRUE)
setwd(arguments[1])
observers <- as.integer(arguments[2])
library(survival)
for (file in c("report.R", "report_course.R", "report_curves.R", "report_pictures.R", "report_tests.R")) source(file)
wrong <- character()
expect <- function(what, found, truth, tolerance) if (!isTRUE(all(abs(found - truth) <= tolerance)))
  wrong <<- c(wrong, sprintf("%s: %s, truth %s", what, paste(signif(found, 8), collapse = " "), paste(signif(truth, 8), collapse = " ")))
quietly <- function(expression) invisible(capture.output(expression))

# ---- Values in order ----
set.seed(3)
n <- 30
data <- expand.grid(method = c("a", "b", "c"), participant_id = sprintf("p%02d", 1:n))
person <- rnorm(n, 0, 1)[as.integer(data$participant_id)]
data$score <- findInterval(c(0, 0.8, 1.2)[as.integer(data$method)] + person + rlogis(nrow(data)), c(-1, 0.5, 2))
shift <- cbind(data$method == "b", data$method == "c")
log_likelihood <- function(par, columns) {
  cuts <- c(-Inf, cumsum(c(par[1], exp(par[2:3]))), Inf)
  u <- seq(-6, 6, length.out = 151)
  weight <- dnorm(u) * diff(u[1:2])
  at <- as.vector(shift[, columns, drop = FALSE] %*% par[-(1:4)])
  p <- sapply(u, function(v) plogis(cuts[data$score + 2] - at - exp(par[4]) * v) - plogis(cuts[data$score + 1] - at - exp(par[4]) * v))
  sum(log(as.vector(rowsum(log(p), data$participant_id) |> exp() |> (\(each) each %*% weight)())))
}
highest <- function(columns) {
  fit <- optim(c(-1, 0, 0, 0, rep(0, length(columns))), function(par) -log_likelihood(par, columns), method = "BFGS",
               control = list(reltol = 1e-12, maxit = 500))
  list(value = -fit$value, b = fit$par[-(1:4)])
}
whole <- highest(1:2)
less <- highest(integer())
p <- NULL
quietly(p <- show_ordinal("o", ordinal_model(data, "score", "method"), data, "score", "method"))
expect("ordinal, ratio of likelihoods", report$results[["o.method.chisq"]], 2 * (whole$value - less$value), 0.02)
expect("ordinal, odds", log(c(report$results[["o.odds.method.1.ratio"]], report$results[["o.odds.method.2.ratio"]])), whole$b, 0.02)
expect("ordinal, p", p[["method"]], pchisq(2 * (whole$value - less$value), 2, lower.tail = FALSE), 1e-3)

# ---- Equivalence ----
x <- rnorm(15, 5, 1)
y <- x + rnorm(15, 0.1, 0.4)
quietly(p <- show_equivalence("e", list(a = x, b = y), "value", "method", c(-0.5, 0.4), TRUE))
d <- x - y
se <- sqrt(sum((d - mean(d))^2) / 14 / 15)
t <- c((mean(d) + 0.5) / se, (mean(d) - 0.4) / se)
expect("equivalence, t", c(report$results[["e.above.t"]], report$results[["e.below.t"]]), t, 1e-9)
expect("equivalence, p", p[["method"]], max(pt(t[1], 14, lower.tail = FALSE), pt(t[2], 14)), 1e-9)
expect("equivalence, interval", c(report$results[["e.estimate.lo"]], report$results[["e.estimate.hi"]]),
       mean(d) + c(-1, 1) * qt(0.95, 14) * se, 1e-9)

# ---- What a test can find ----
eta <- detectable_eta(2, 30)
drawn <- rchisq(2e5, 2, ncp = eta * 30 / (1 - eta)) / 2 / (rchisq(2e5, 30) / 30)
expect("sensitivity", mean(drawn > qf(0.95, 2, 30)), 0.8, 0.005)

# ---- Families ----
quietly(show_family("times", list(a1 = c(method = 0.01, push = 0.04), a2 = NULL, a3 = c(method = 0.03))))
expect("family", unlist(mget(c("family.times.a1.method.p_holm", "family.times.a1.push.p_holm", "family.times.a3.method.p_holm"), report$results)),
       c(0.03, 0.06, 0.06), 1e-12)

# ---- Psychometric functions ----
# Nine levels with 40 answers each; threshold 1. Means of so few observers lie within 4 of their standard errors around the
# mark.
for (guess in c(0, 0.5)) for (lapse in c(0.02, 0.08)) {
  sigma <- 0.2
  x <- 1 + sigma * seq(-3, 3, length.out = 9)
  seen <- replicate(observers, {
    k <- rbinom(9, 40, guess + (1 - guess - lapse) * pnorm((x - 1) / sigma))
    fit <- fit_curve(x, k, rep(40, 9), guess)
    bounds <- curve_bounds(fit, x, k, rep(40, 9), guess, 1)
    c(fit$par[1], !isTRUE(bounds[1] > 1) && !isTRUE(bounds[2] < 1))
  })
  mark <- sigma * (if (lapse > 0.05) 0.1 else 0.05) + 4 * sd(seen[1, ]) / sqrt(observers)
  expect(paste("threshold at guess", guess, "lapse", lapse), mean(seen[1, ]), 1, mark)
  least <- qbinom(1e-4, observers, 0.93) / observers
  if (mean(seen[2, ]) < least) wrong <- c(wrong, sprintf("intervals at guess %g lapse %g have the threshold in %g", guess, lapse, mean(seen[2, ])))
}

if (length(report$not_computed) > 0) wrong <- c(wrong, unlist(report$not_computed))
if (length(wrong) > 0) cat(wrong, sep = "\n")
cat(sprintf("%d faults\n", length(wrong)))
if (length(wrong) > 0) quit(status = 1)
