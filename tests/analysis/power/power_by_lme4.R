# The share of studies that find an effect, by packages alone: persons, times and the effect's spread are simulated by
# lme4, the tests are R's own. Arguments: studies, effect, spread. Prints a line per test.
args <- as.numeric(commandArgs(TRUE))
studies <- args[1]
effect <- args[2]
spread <- args[3]
suppressPackageStartupMessages({
  library(lme4)
  library(survival)
})
set.seed(1)
grid <- expand.grid(trial = 1:4, level = c("a", "b", "d"), person = factor(1:24))
grid$at_d <- as.numeric(grid$level == "d")
sigma <- 0.8
times <- simulate(~ at_d + (1 | person) + (0 + at_d | person), newdata = grid, nsim = studies, family = gaussian,
                  newparams = list(beta = c(6, effect), theta = c(0.6, spread) / sigma, sigma = sigma))
timeout <- 7
found <- vapply(times, function(time) {
  grid$time <- time
  means <- aggregate(time ~ person + level, grid, mean)
  wide <- split(means$time, means$level)
  fit <- aov(time ~ level + Error(person / level), means)
  grid$finished <- as.numeric(grid$time <= timeout)
  grid$seen <- pmin(grid$time, timeout)
  cox <- coxph(Surv(seen, finished) ~ level + strata(person), grid)
  mixed <- suppressMessages(lmerTest::lmer(time ~ level + (1 | person), means))
  c(paired_t = t.test(wide$d, wide$a, paired = TRUE)$p.value,
    rm_anova = summary(fit)[[2]][[1]][1, "Pr(>F)"],
    lmm = anova(mixed)[1, "Pr(>F)"],
    survival = pchisq(2 * diff(cox$loglik), 2, lower.tail = FALSE))
}, numeric(4))
for (test in rownames(found)) cat(test, mean(found[test, ] < 0.05), "\n")
