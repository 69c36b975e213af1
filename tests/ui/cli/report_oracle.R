# The planned tests of a study once more, in base R, from trials.csv and codebook.csv alone:
#   Rscript report_oracle.R FOLDER SPEC RULES EXCLUDED
# SPEC: a table of what the test planned: analysis, outcome, block, test, horizon_s, within, between (; between names) and
# more. RULES: what is left out by value: data, value, below, above. EXCLUDED: codes, parted by commas. Says what differs from the results.json in FOLDER; exit code 1 if anything does.
# Truth: the definitions of the statistics, written out: products of survival, sums of squares, exact distributions by
# listing all cases, likelihoods by their closed form. No package, no function of R that does the test as a whole.
arguments <- commandArgs(trailingOnly = TRUE)
folder <- arguments[1]
spec <- read.csv(arguments[2], colClasses = "character", na.strings = NULL)
rules <- read.csv(arguments[3], colClasses = "character", na.strings = NULL)
excluded <- strsplit(arguments[4], ",")[[1]]

codebook <- read.csv(file.path(folder, "codebook.csv"), colClasses = "character", na.strings = NULL)
trials <- read.csv(file.path(folder, "trials.csv"), colClasses = "character", na.strings = "NA")
levels_of <- function(factor) if (factor == "block") c("main", "again") else strsplit(codebook$levels[codebook$file == "trials.csv" & codebook$column == factor], "; ", fixed = TRUE)[[1]]

# results.json has a number a line; the list of results ends before the list of cells.
lines <- readLines(file.path(folder, "results.json"))
lines <- lines[seq(which(grepl("\"results\": ", lines)) + 1, which(grepl("^  \"cells\": ", lines)) - 2)]
results <- setNames(suppressWarnings(as.numeric(sub("^.*\": ([^,]*),?$", "\\1", lines))), sub("^ *\"(.*)\": .*$", "\\1", lines))

compared <- 0
wrong <- character()
expect <- function(id, truth, relative = 1e-8) {
  compared <<- compared + 1
  found <- results[id]
  if (is.na(truth) && is.na(found) && id %in% names(results)) return(invisible())
  if (!isTRUE(abs(found - truth) <= relative * max(1, abs(truth)))) wrong <<- c(wrong, sprintf("%s: %.12g, truth %.12g", id, found, truth))
}

# ---- Cells -----------------------------------------------------------------------------------------------------------

# Area under the product of (1 - finished / still there), from 0 to the horizon, level after the last time.
restricted_mean <- function(time, finished, horizon) {
  area <- 0; survival <- 1; before <- 0
  for (t in sort(unique(time[time <= horizon]))) {
    area <- area + survival * (t - before)
    survival <- survival * (1 - sum(finished[time == t]) / sum(time >= t))
    before <- t
  }
  area + survival * (horizon - before)
}

counts <- trials$valid == "1" & trials$phase == "main" & trials$outcome %in% c("success", "failure", "timeout") & !(trials$participant_id %in% excluded)
people <- sort(unique(trials$participant_id[!(trials$participant_id %in% excluded)]))
is_outside <- function(rule, x) !is.na(x) & ((rule$below != "" & x < suppressWarnings(as.numeric(rule$below))) %in% TRUE |
                                              (rule$above != "" & x > suppressWarnings(as.numeric(rule$above))) %in% TRUE)
for (i in which(rules$data == "trials")) counts <- counts & !is_outside(rules[i, ], as.numeric(trials[[rules$value[i]]]))
for (i in which(rules$data == "participants")) {
  x <- as.numeric(trials[[rules$value[i]]])
  means <- sapply(people, function(p) mean(x[counts & trials$participant_id == p], na.rm = TRUE))
  people <- people[!is_outside(rules[i, ], means)]
}
counts <- counts & trials$participant_id %in% people
# The mean of the six ratings of each form.
items <- read.csv(file.path(folder, "questionnaire_items.csv"), colClasses = "character", na.strings = "NA")
workload <- function(p) {
  its <- items[items$participant_id == p & items$questionnaire == "nasa_tlx_raw", ]
  mean(tapply(as.numeric(its$value), its$condition, mean))
}

# A matrix: a row a person who has all, a column a combination of the within factors, the first one slowest.
cells_of <- function(plan, within) {
  if (plan$outcome == "nasa_tlx_raw.workload") return(list(at = data.frame(all = 1), y = matrix(sapply(people, workload), dimnames = list(people, NULL))))
  rows <- trials[counts & (plan$block == "" | trials$block == plan$block), ]
  value <- as.numeric(rows[[plan$outcome]])
  finished <- as.numeric(rows$finished)
  condition <- paste(rows$condition, rows$block)
  by_condition <- sapply(unique(condition), function(c) sapply(people, function(p) {
    its <- rows$participant_id == p & condition == c & !is.na(value)
    if (!any(its)) NA else if (plan$outcome == "time_s") restricted_mean(value[its], finished[its], as.numeric(plan$horizon_s)) else mean(value[its])
  }))
  by_condition <- matrix(by_condition, length(people), dimnames = list(people, unique(condition)))
  at <- rev(expand.grid(rev(lapply(setNames(within, within), levels_of)), stringsAsFactors = FALSE))
  if (length(within) == 0) at <- data.frame(all = 1)
  cells <- sapply(seq_len(nrow(at)), function(i) {
    of <- unique(condition[Reduce(`&`, lapply(within, function(f) rows[[f]] == at[[f]][i]), rep(TRUE, nrow(rows)))])
    rowMeans(by_condition[, of, drop = FALSE], na.rm = TRUE)
  })
  cells <- matrix(cells, length(people), dimnames = list(people, NULL))
  if (plan$transform == "log") cells <- log(cells)
  list(at = at, y = cells[!apply(is.nan(cells) | is.na(cells), 1, any), , drop = FALSE])
}

group_of <- function(persons, between) {
  rows <- trials[match(persons, trials$participant_id), between, drop = FALSE]
  data.frame(lapply(setNames(between, between), function(f) factor(rows[[f]], levels_of(f))))
}

check_cell <- function(id, y) {
  expect(paste0(id, ".n"), length(y))
  expect(paste0(id, ".mean"), sum(y) / length(y))
  s <- if (length(y) > 1) sqrt(sum((y - sum(y) / length(y))^2) / (length(y) - 1)) else NA
  expect(paste0(id, ".sd"), s)
  half <- if (length(y) > 1) qt(0.975, length(y) - 1) * s / sqrt(length(y)) else NA
  expect(paste0(id, ".lo"), sum(y) / length(y) - half)
  expect(paste0(id, ".hi"), sum(y) / length(y) + half)
}

# ---- Tests -----------------------------------------------------------------------------------------------------------

unbiased <- function(df) exp(lgamma(df / 2) - lgamma((df - 1) / 2)) / sqrt(df / 2)

check_t <- function(id, estimate, se, df) {
  expect(paste0(id, ".estimate"), estimate)
  expect(paste0(id, ".estimate.lo"), estimate - qt(0.975, df) * se)
  expect(paste0(id, ".estimate.hi"), estimate + qt(0.975, df) * se)
  expect(paste0(id, ".t"), estimate / se)
  expect(paste0(id, ".df"), df)
  expect(paste0(id, ".p"), 2 * pt(-abs(estimate / se), df))
}

# Holm: the smallest p times how many there are, the next times one less, never falling.
holm <- function(p) { o <- order(p); q <- pmin(1, cummax(p[o] * rev(seq_along(p)))); q[order(o)] }

check_signed_ranks <- function(id, d) {
  d <- round(d, 9)
  walsh <- sort(unlist(lapply(seq_along(d), function(i) (d[i] + d[i:length(d)]) / 2)))
  all <- length(walsh)
  expect(paste0(id, ".estimate"), if (all %% 2 == 1) walsh[(all + 1) / 2] else mean(walsh[all / 2 + 0:1]))
  # The order statistic: as many signs as leave the sum of ranks, without ties, at or below it with 2.5 %.
  sums <- as.vector(as.matrix(expand.grid(rep(list(0:1), length(d)))) %*% seq_along(d))
  at <- max(1, min(which(cumsum(tabulate(sums + 1, all + 1)) / 2^length(d) >= 0.025)) - 1)
  expect(paste0(id, ".estimate.lo"), walsh[at])
  expect(paste0(id, ".estimate.hi"), walsh[all + 1 - at])
  d <- d[d != 0]
  r <- rank(abs(d))
  plus <- sum(r[d > 0])
  sums <- as.vector(as.matrix(expand.grid(rep(list(0:1), length(d)))) %*% r)
  expect(paste0(id, ".p"), mean(abs(sums - sum(r) / 2) >= abs(plus - sum(r) / 2) - 1e-9))
  expect(paste0(id, ".z"), (plus - sum(r) / 2) / sqrt(sum(r^2) / 4))
  expect(paste0(id, ".r"), (2 * plus - sum(r)) / sum(r))
  mean(abs(sums - sum(r) / 2) >= abs(plus - sum(r) / 2) - 1e-9)
}

tests <- list(
  paired_t = function(id, cells, plan, within, between) {
    d <- cells$y[, 1] - cells$y[, 2]
    n <- length(d)
    s <- sqrt(sum((d - mean(d))^2) / (n - 1))
    check_t(id, mean(d), s / sqrt(n), n - 1)
    expect(paste0(id, ".dz"), mean(d) / s)
    expect(paste0(id, ".g"), mean(d) / s * unbiased(n - 1))
  },
  welch_t = function(id, cells, plan, within, between) {
    group <- group_of(rownames(cells$y), between)[[1]]
    x <- cells$y[as.integer(group) == 1, 1]; y <- cells$y[as.integer(group) == 2, 1]
    v <- c(sum((x - mean(x))^2) / (length(x) - 1) / length(x), sum((y - mean(y))^2) / (length(y) - 1) / length(y))
    check_t(id, mean(x) - mean(y), sqrt(sum(v)), sum(v)^2 / sum(v^2 / (c(length(x), length(y)) - 1)))
  },
  mean = function(id, cells, plan, within, between) {
    y <- cells$y[, 1]
    se <- sqrt(sum((y - mean(y))^2) / (length(y) - 1) / length(y))
    expect(paste0(id, ".estimate"), mean(y))
    expect(paste0(id, ".estimate.lo"), mean(y) - qt(0.975, length(y) - 1) * se)
    expect(paste0(id, ".estimate.hi"), mean(y) + qt(0.975, length(y) - 1) * se)
  },
  wilcoxon = function(id, cells, plan, within, between) check_signed_ranks(id, cells$y[, 1] - cells$y[, 2]),
  mann_whitney = function(id, cells, plan, within, between) {
    group <- as.integer(group_of(rownames(cells$y), between)[[1]])
    v <- round(cells$y[, 1], 9)
    r <- rank(v)
    n1 <- sum(group == 1); n <- length(v)
    all <- combn(n, n1, function(of) sum(r[of]))
    centre <- n1 * (n + 1) / 2
    expect(paste0(id, ".p"), mean(abs(all - centre) >= abs(sum(r[group == 1]) - centre) - 1e-9))
    expect(paste0(id, ".z"), (sum(r[group == 1]) - centre) / sqrt(mean((all - mean(all))^2)))
    between_pairs <- sort(as.vector(outer(v[group == 1], v[group == 2], "-")))
    expect(paste0(id, ".estimate"), median(between_pairs))
    counts <- table(factor(combn(n, n1, sum) - n1 * (n1 + 1) / 2, 0:length(between_pairs)))
    at <- max(1, min(which(cumsum(counts) / sum(counts) >= 0.025)) - 1)
    expect(paste0(id, ".estimate.lo"), between_pairs[at])
    expect(paste0(id, ".estimate.hi"), between_pairs[length(between_pairs) + 1 - at])
    expect(paste0(id, ".r"), mean(sign(round(outer(v[group == 1], v[group == 2], "-"), 12))))
  },
  friedman = function(id, cells, plan, within, between) {
    r <- t(apply(round(cells$y, 9), 1, rank))
    n <- nrow(r); k <- ncol(r)
    chisq <- (k - 1) * sum((colSums(r) - n * (k + 1) / 2)^2) / (sum(r^2) - n * k * (k + 1)^2 / 4)
    expect(paste0(id, ".chisq"), chisq)
    expect(paste0(id, ".df"), k - 1)
    expect(paste0(id, ".p"), pchisq(chisq, k - 1, lower.tail = FALSE))
    expect(paste0(id, ".w"), chisq / (n * (k - 1)))
    pairs <- combn(k, 2)
    p <- sapply(seq_len(ncol(pairs)), function(i) check_signed_ranks(paste0(id, ".pair.", within, ".", i), cells$y[, pairs[1, i]] - cells$y[, pairs[2, i]]))
    for (i in seq_along(p)) expect(paste0(id, ".pair.", within, ".", i, ".p_holm"), holm(p)[i])
  },
  rm_anova = function(id, cells, plan, within, between) check_anova(id, cells, within, between, plan$contrast),
  equivalence = function(id, cells, plan, within, between) check_equivalence(id, cells, plan, between),
  survival = function(id, cells, plan, within, between) check_cox(id, plan, rownames(cells$y), within),
  mixed_anova = function(id, cells, plan, within, between) check_anova(id, cells, within, between),
  lmm = function(id, cells, plan, within, between)
    if (plan$covariate == "") check_lmm(id, cells, within, between) else check_reml(id, cells, plan, within))

# Two one-sided tests of a difference against its bounds.
check_equivalence <- function(id, cells, plan, between) {
  if (length(between) == 0) {
    d <- cells$y[, 1] - cells$y[, 2]
    estimate <- mean(d); se <- sqrt(sum((d - mean(d))^2) / (length(d) - 1) / length(d)); df <- length(d) - 1
  } else {
    group <- as.integer(group_of(rownames(cells$y), between)[[1]])
    v <- sapply(1:2, function(g) { x <- cells$y[group == g, 1]; sum((x - mean(x))^2) / (length(x) - 1) / length(x) })
    estimate <- mean(cells$y[group == 1, 1]) - mean(cells$y[group == 2, 1])
    se <- sqrt(sum(v)); df <- sum(v)^2 / sum(v^2 / (tabulate(group) - 1))
  }
  low <- (estimate - as.numeric(plan$low)) / se; high <- (estimate - as.numeric(plan$high)) / se
  expect(paste0(id, ".estimate"), estimate)
  expect(paste0(id, ".estimate.lo"), estimate - qt(0.95, df) * se)
  expect(paste0(id, ".estimate.hi"), estimate + qt(0.95, df) * se)
  expect(paste0(id, ".above.t"), low)
  expect(paste0(id, ".below.t"), high)
  expect(paste0(id, ".p"), max(pt(low, df, lower.tail = FALSE), pt(high, df)))
}

# One intercept for each person and a covariate: the restricted likelihood of the variances, climbed by hand.
check_reml <- function(id, cells, plan, within) {
  rows <- trials[counts & trials$block == plan$block & trials$participant_id %in% rownames(cells$y), ]
  place <- as.vector(sapply(seq_len(nrow(cells$at)), function(i) {
    its <- Reduce(`&`, lapply(within, function(f) rows[[f]] == cells$at[[f]][i]))
    sapply(rownames(cells$y), function(p) mean(as.numeric(rows$order_position[its & rows$participant_id == p])))
  }))
  n <- nrow(cells$y); k <- ncol(cells$y); y <- as.vector(cells$y)
  x <- cbind(1, sapply(seq_len(k)[-1], function(i) as.numeric(rep(seq_len(k), each = n) == i)), place)
  same <- outer(rep(seq_len(n), k), rep(seq_len(n), k), "==")
  parts <- function(ratio) {
    v <- diag(n * k) + ratio * same
    w <- solve(v)
    b <- solve(t(x) %*% w %*% x, t(x) %*% w %*% y)
    r <- y - x %*% b
    s2 <- as.numeric(t(r) %*% w %*% r) / (n * k - ncol(x))
    list(s2 = s2, loss = as.numeric(determinant(v)$modulus + determinant(t(x) %*% w %*% x)$modulus) + (n * k - ncol(x)) * log(s2))
  }
  ratio <- exp(optimize(function(l) parts(exp(l))$loss, c(-14, 8), tol = 1e-9)$minimum)
  if (parts(0)$loss <= parts(ratio)$loss) ratio <- 0
  expect(paste0(id, ".sd_residual"), sqrt(parts(ratio)$s2), 1e-3)
  expect(paste0(id, ".sd_participants"), sqrt(ratio * parts(ratio)$s2), 5e-3)
}

orthonormal <- function(k) apply(contr.helmert(k), 2, function(c) c / sqrt(sum(c^2)))

# The part of the cells that belongs to a set of within factors: orthonormal contrasts of those, plain means of others.
part_of <- function(within, set) {
  m <- matrix(1)
  for (f in within) {
    k <- length(levels_of(f))
    m <- kronecker(m, if (f %in% set) orthonormal(k) else matrix(1 / sqrt(k), k))
  }
  m
}

subsets <- function(x) unlist(lapply(0:length(x), function(m) if (m == 0) list(character()) else combn(x, m, simplify = FALSE)), recursive = FALSE)

residual <- function(y, x) y - x %*% solve(crossprod(x), crossprod(x, y))

# Sums of squares of the third kind: persons' scores on each within part, against groups coded to sum to zero.
strata_of <- function(y, within, between) {
  groups <- if (length(between) > 0) group_of(rownames(y), between)
  codes <- lapply(setNames(between, between), function(f) { c <- contr.sum(nlevels(groups[[f]])); c[as.integer(groups[[f]]), , drop = FALSE] })
  columns <- lapply(subsets(between), function(set) {
    x <- matrix(1, nrow(y))
    for (f in set) x <- do.call(cbind, lapply(seq_len(ncol(x)), function(i) x[, i] * codes[[f]]))
    list(set = set, x = x)
  })
  whole <- do.call(cbind, lapply(columns, `[[`, "x"))
  unlist(lapply(subsets(within), function(set) {
    scores <- y %*% part_of(within, set)
    error <- crossprod(residual(scores, whole))
    lapply(columns, function(column) {
      if (length(set) == 0 && length(column$set) == 0) return(NULL)
      less <- do.call(cbind, lapply(columns[!sapply(columns, identical, column)], `[[`, "x"))
      left <- if (is.null(less)) scores else residual(scores, less)
      list(within = set, between = column$set, ss = sum(diag(crossprod(left))) - sum(diag(error)), error = error,
           df1 = ncol(column$x) * ncol(scores), q = ncol(scores), df2 = (nrow(y) - ncol(whole)) * ncol(scores))
    })
  }), recursive = FALSE)
}

find_id <- function(id, factors, what) {
  candidates <- names(results)[endsWith(names(results), paste0(".", what)) & startsWith(names(results), paste0(id, "."))]
  its <- substring(candidates, nchar(id) + 2, nchar(candidates) - nchar(what) - 1)
  hit <- candidates[sapply(strsplit(its, ":"), function(parts) setequal(parts, factors))]
  if (length(hit) == 1) hit else paste0(id, ".", paste(factors, collapse = ":"), ".", what)
}

check_differences <- function(id, cells, within, between, contrast = "") {
  y <- cells$y
  groups <- if (length(between) > 0) group_of(rownames(y), between)
  cell <- if (length(between) > 0) interaction(groups, drop = TRUE) else factor(rep(1, nrow(y)))
  means <- apply(y, 2, function(v) tapply(v, cell, mean)); means <- matrix(means, nlevels(cell))
  n <- as.vector(table(cell))
  df <- nrow(y) - nlevels(cell)
  error <- crossprod(y - means[as.integer(cell), , drop = FALSE]) / df
  at <- if (length(between) > 0) groups[match(levels(cell), cell), , drop = FALSE]
  for (f in c(within, between)) {
    k <- length(levels_of(f)); pairs <- combn(k, 2)
    if (contrast != "") {
      of <- strsplit(contrast, ": | - ")[[1]]
      if (of[1] != f) {
        if (any(startsWith(names(results), paste0(id, ".pair.", f)))) wrong <<- c(wrong, paste(id, f, "has differences that are not planned"))
        next
      }
      pairs <- matrix(match(of[2:3], levels_of(f)), 2)
    }
    rows <- lapply(seq_len(ncol(pairs)), function(i) {
      weight <- function(which) { w <- which / sum(which) }
      a <- levels_of(f)[pairs[1, i]]; b <- levels_of(f)[pairs[2, i]]
      if (f %in% within) {
        over <- weight(cells$at[[f]] == a) - weight(cells$at[[f]] == b); by <- rep(1 / nlevels(cell), nlevels(cell))
      } else {
        over <- rep(1 / ncol(y), ncol(y)); by <- weight(at[[f]] == a) - weight(at[[f]] == b)
      }
      c(estimate = sum(by * (means %*% over)), se = sqrt(sum(by^2 / n) * as.numeric(t(over) %*% error %*% over)))
    })
    p <- sapply(rows, function(r) 2 * pt(-abs(r[["estimate"]] / r[["se"]]), df))
    for (i in seq_along(rows)) {
      pair <- paste0(id, ".pair.", f, ".", i)
      check_t(pair, rows[[i]][["estimate"]], rows[[i]][["se"]], df)
      expect(paste0(pair, ".p_holm"), holm(p)[i])
    }
  }
}

check_anova <- function(id, cells, within, between, contrast = "") {
  strata <- Filter(Negate(is.null), strata_of(cells$y, within, between))
  key <- sapply(strata, function(s) paste(s$within, collapse = ":"))
  all_errors <- sum(sapply(strata[!duplicated(key)], function(s) sum(diag(s$error))))
  if (length(between) == 0) all_errors <- all_errors + sum(diag(crossprod(scale(cells$y %*% part_of(within, character()), scale = FALSE))))
  for (s in strata) {
    at <- function(what) find_id(id, c(s$within, s$between), what)
    e <- sum(diag(s$error)); f <- (s$ss / s$df1) / (e / s$df2)
    expect(at("F"), f); expect(at("df1"), s$df1); expect(at("df2"), s$df2)
    expect(at("p"), pf(f, s$df1, s$df2, lower.tail = FALSE))
    expect(at("pes"), s$ss / (s$ss + e)); expect(at("ges"), s$ss / (s$ss + all_errors))
    if (s$q > 1) {
      epsilon <- e^2 / (s$q * sum(s$error^2))
      expect(at("gg_epsilon"), epsilon)
      expect(at("gg_p"), pf(f, s$df1 * epsilon, s$df2 * epsilon, lower.tail = FALSE))
    }
  }
  check_differences(id, cells, within, between, contrast)
}

# Balanced data and one intercept for each person: where persons differ more than residuals do, REML is the classical
# analysis with one common residual; where they do not, persons are no stratum of their own.
check_lmm <- function(id, cells, within, between) {
  strata <- Filter(Negate(is.null), strata_of(cells$y, within, between))
  n <- nrow(cells$y); k <- ncol(cells$y)
  groups <- if (length(between) > 0) prod(sapply(between, function(f) length(levels_of(f)))) else 1
  key <- sapply(strata, function(s) paste(s$within, collapse = ":"))
  inner <- !duplicated(key) & sapply(strata, function(s) length(s$within) > 0)
  ss_inner <- sum(sapply(strata[inner], function(s) sum(diag(s$error)))); df_inner <- (n - groups) * (k - 1)
  outer <- if (length(between) > 0) sum(diag(strata[[which(sapply(strata, function(s) length(s$within) == 0))[1]]]$error)) else
    sum(scale(cells$y %*% part_of(within, character()), scale = FALSE)^2)
  df_outer <- n - groups
  singular <- df_inner > 0 && outer / df_outer <= ss_inner / df_inner
  if (singular) { common <- (ss_inner + outer) / (df_inner + df_outer); ms <- c(common, common) } else ms <- c(ss_inner / df_inner, outer / df_outer)
  for (s in strata) {
    f <- s$ss / s$df1 / ms[if (length(s$within) > 0) 1 else 2]
    at <- function(what) find_id(id, c(s$within, s$between), what)
    expect(at("F"), f, 1e-4)
    expect(at("df1"), s$df1)
    if (!singular) {
      df <- if (length(s$within) > 0) df_inner else df_outer
      expect(at("df2"), df, 1e-3)
      expect(at("p"), pf(f, s$df1, df, lower.tail = FALSE), 1e-4)
    }
  }
  expect(paste0(id, ".sd_residual"), sqrt(ms[1]), 1e-4)
  expect(paste0(id, ".sd_participants"), sqrt(max(0, (ms[2] - ms[1]) / k)), 1e-3)
}

# ---- Times that a time-out cut off -----------------------------------------------------------------------------------

# Efron's partial likelihood of proportional hazards, in strata: its maximum by Newton's way; of each factor the ratio of
# likelihoods with and without it.
check_cox <- function(id, plan, persons, within) {
  rows <- trials[counts & trials$block == plan$block & trials$participant_id %in% persons & !is.na(trials$time_s), ]
  time <- as.numeric(rows$time_s); done <- as.numeric(rows$finished)
  if (length(within) == 0 || all(done == 1) || all(done == 0)) return(invisible())
  x <- do.call(cbind, lapply(within, function(f) sapply(levels_of(f)[-1], function(l) as.numeric(rows[[f]] == l))))
  of <- rep(within, sapply(within, function(f) length(levels_of(f)) - 1))
  at <- function(b, x) {
    slope <- numeric(ncol(x)); curve <- matrix(0, ncol(x), ncol(x)); value <- 0
    for (p in unique(rows$participant_id)) {
      i <- rows$participant_id == p
      xs <- x[i, , drop = FALSE]; w <- exp(as.vector(xs %*% b)); ts <- time[i]; ds <- done[i]
      for (t in unique(ts[ds == 1])) {
        risk <- ts >= t; event <- which(ts == t & ds == 1); m <- length(event)
        value <- value + sum(xs[event, , drop = FALSE] %*% b)
        for (j in seq_len(m) - 1) {
          v <- w * risk; v[event] <- v[event] * (1 - j / m)
          mean_x <- colSums(v * xs) / sum(v)
          value <- value - log(sum(v))
          slope <- slope - mean_x
          curve <- curve + crossprod(xs, v * xs) / sum(v) - tcrossprod(mean_x)
        }
        slope <- slope + colSums(xs[event, , drop = FALSE])
      }
    }
    list(b = b, value = value, slope = slope, curve = curve)
  }
  # Nothing where the maximum is at no finite place.
  highest <- function(x) {
    b <- numeric(ncol(x))
    for (step in 1:60) {
      now <- at(b, x)
      if (ncol(x) == 0) return(now)
      if (rcond(now$curve) < 1e-10 || max(abs(b)) > 9) return(NULL)
      if (max(abs(now$slope)) < 1e-9) return(now)
      b <- b + solve(now$curve, now$slope)
    }
    NULL
  }
  full <- highest(x)
  if (is.null(full)) return(invisible())
  error <- sqrt(diag(solve(full$curve)))
  for (f in within) {
    its <- which(of == f)
    less <- highest(x[, -its, drop = FALSE])
    if (is.null(less)) next
    expect(paste0(id, ".cox.", f, ".chisq"), 2 * (full$value - less$value), 1e-4)
    expect(paste0(id, ".cox.", f, ".p"), pchisq(2 * (full$value - less$value), length(its), lower.tail = FALSE), 1e-4)
    for (k in seq_along(its)) {
      row <- paste0(id, ".cox.", f, ".", k, ".hr")
      expect(row, exp(full$b[its[k]]), 1e-4)
      expect(paste0(row, ".lo"), exp(full$b[its[k]] - qnorm(0.975) * error[its[k]]), 1e-4)
      expect(paste0(row, ".hi"), exp(full$b[its[k]] + qnorm(0.975) * error[its[k]]), 1e-4)
    }
  }
}

# ---- All analyses ----------------------------------------------------------------------------------------------------

expect("flow.people.enrolled", length(unique(trials$participant_id)))
expect("flow.people.counted", length(people))
expect("flow.attempts.made", nrow(trials))
expect("flow.attempts.counted", sum(counts))
for (i in seq_len(nrow(spec))) {
  plan <- spec[i, ]
  id <- paste0("a", plan$analysis)
  names_in <- function(text) if (text == "") character() else strsplit(text, ";")[[1]]
  within <- names_in(plan$within); between <- names_in(plan$between)
  cells <- cells_of(plan, within)
  persons <- rownames(cells$y)
  expect(paste0(id, ".n"), length(persons))
  expect(paste0(id, ".n_counted"), length(people))
  # Cells are numbered by the factors as the protocol lists them for the analysis.
  factors <- names_in(plan$factors)
  groups <- if (length(between) > 0) group_of(persons, between)
  at <- rev(expand.grid(rev(lapply(setNames(factors, factors), levels_of)), stringsAsFactors = FALSE))
  number <- 0
  for (r in seq_len(max(1, nrow(at)))) {
    column <- if (length(within) > 0) which(Reduce(`&`, lapply(within, function(f) cells$at[[f]] == at[[f]][r]))) else 1
    row <- Reduce(`&`, lapply(between, function(f) groups[[f]] == at[[f]][r]), rep(TRUE, length(persons)))
    if (!any(row)) next
    number <- number + 1
    check_cell(paste0(id, ".cell.", number), cells$y[row, column])
  }
  tests[[plan$test]](id, cells, plan, within, between)
  if (plan$outcome == "time_s" && length(between) == 0 && plan$test != "survival") check_cox(id, plan, persons, within)
}
# p values of a family, as they stand, by Holm.
its <- spec[spec$family != "", ]
if (nrow(its) > 0) {
  of <- paste0("family.", its$family, ".a", its$analysis, ".", its$factors)
  adjusted <- holm(results[paste0("a", its$analysis, ".p")])
  for (i in seq_along(of)) expect(paste0(of[i], ".p_holm"), adjusted[[i]])
}
if (length(wrong) > 0) cat(wrong, sep = "\n")
cat(sprintf("%d numbers compared, %d wrong\n", compared, length(wrong)))
if (length(wrong) > 0 || compared == 0) quit(status = 1)
