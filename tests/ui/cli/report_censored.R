# Rscript report_censored.R FOLDER DIFFER ALIKE: so many studies whose times were drawn here, through the model of censored times of the folder's
# report_tests.R. 24 persons with 8 trials in each of two conditions, times of successes alike: with 5 % and 30 % time-outs the
# conditions differ, in 95 % of studies at least; with 15 % in both they do not: in 7 % of 2 000 at most, of fewer studies in no
# more than chance leaves of 5 % but once in 10 000 times.
# Truth: the shares were drawn so. The model keeps 5 %; the rest of the mark is what 2 000 studies leave to chance, and small
# samples. Where it differs and the means do not, the page has to say so.
arguments <- commandArgs(trailingOnly = TRUE)
setwd(arguments[1])
library(survival)
source("report.R")
source("report_tests.R")
set.seed(7)

draw <- function(shares) {
  n <- 24
  trials <- expand.grid(trial = 1:8, method = c("a", "b"), person = seq_len(n))
  pace <- exp(rnorm(n, 0, 0.3))
  late <- runif(nrow(trials)) < shares[match(trials$method, c("a", "b"))]
  time <- pmin(3 * pace[trials$person] * exp(rnorm(nrow(trials), 0, 0.4)), 9.9)
  data.frame(participant_id = factor(trials$person), method = factor(trials$method), time_s = ifelse(late, 10, time), finished = as.numeric(!late))
}

share_of <- function(times, shares, planned) {
  hits <- 0
  for (time in seq_len(times)) {
    report$results <- report$shown <- report$warnings <- report$not_computed <- list()
    page <- capture.output(show_censored("a", draw(shares), c(method = planned), within = "method"))
    if (length(report$not_computed) > 0) stop(report$not_computed[[1]])
    hit <- report$results[["a.cox.method.p"]] < 0.05
    if (hit) hits <- hits + 1
    if (hit != any(grepl("disagree", page))) stop("the page does not say that both disagree, or says it of none")
  }
  hits / times
}
studies <- as.integer(arguments[2:3])
differ <- share_of(studies[1], c(0.05, 0.30), planned = 0.5)
alike <- share_of(studies[2], c(0.15, 0.15), planned = 0.5)
cat(sprintf("differ %.3f, alike %.3f\n", differ, alike))
if (differ < 0.95 || alike > max(0.07, qbinom(1 - 1e-4, studies[2], 0.05) / studies[2])) quit(status = 1)
