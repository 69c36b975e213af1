# A planned analysis: persons, cells, pictures, tests, and what stands beside them.

# ---- An analysis -----------------------------------------------------------------------------------------------------

combination <- function(data, factors) {
  if (length(factors) == 0) return(rep("", nrow(data)))
  do.call(paste, c(unname(lapply(data[factors], as.character)), sep = " / "))
}

# The combinations of the factors that occur, in the order of their levels.
combinations <- function(data, factors) {
  if (length(factors) == 0) return(data.frame(row.names = 1L))
  at <- unique(data[factors])
  at <- at[do.call(order, unname(as.list(at))), , drop = FALSE]
  rownames(at) <- NULL
  at
}

# One mean per person and combination of the factors, of those persons who have a value at each combination within
# persons. Keeps the others by code, with what they lack. `transform` log: the means' natural logarithms.
means_of_people <- function(id, rows, people, value, within = character(), between = character(), transform = "none") {
  at <- combination(rows, within)
  wanted <- combination(combinations(rows, within), within)
  lacks <- function(person) {
    its <- rows$participant_id == person
    if (!any(its)) return("no row of this analysis")
    if (anyNA(rows[its, between])) return("no group")
    missing <- setdiff(wanted, at[its & !is.na(rows[[value]])])
    if (length(missing) == 0) NA_character_ else if (length(within) == 0) "no value" else paste("no value at",
      paste(missing, collapse = "; "))
  }
  why <- vapply(people, lacks, NA_character_, USE.NAMES = FALSE)
  report$left_out[[id]] <- data.frame(participant_id = people[!is.na(why)], reason = why[!is.na(why)])
  rows <- rows[rows$participant_id %in% people[is.na(why)], ]
  data <- if (nrow(rows) > 0) aggregate(rows[value], rows[c("participant_id", within, between)], mean,
                                        na.rm = TRUE) else
    rows[c("participant_id", within, between, value)]
  if (transform == "log") {
    none <- unique(data$participant_id[!(data[[value]] > 0)])
    report$left_out[[id]] <- rbind(report$left_out[[id]],
                                   data.frame(participant_id = none, reason = rep("a value without a logarithm", length(none))))
    data <- data[!(data$participant_id %in% none), ]
    data[[value]] <- log(data[[value]])
  }
  data[c("participant_id", within, between)] <- lapply(data[c("participant_id", within, between)],
    function(x) droplevels(factor(x)))
  out <- report$left_out[[id]]
  para("Analysed: ", count(id %.% "n", nlevels(data$participant_id)), " of ",
       count(id %.% "n_counted", length(people)),
       " counted participants.",
       if (nrow(out) > 0) paste0(" Left out: ",
                                 paste0(name(out$participant_id), " (", name(out$reason), ")", collapse = ", "), "."))
  data[do.call(order, unname(as.list(data[c("participant_id", within)]))), ]
}

# Scores of the forms that count on QUESTIONNAIRE.SCALE, with the factors' levels: those of the condition that a form is
# about, else those that its person has always.
scale_rows <- function(scores, attempts, outcome, factors) {
  rows <- scores[scores$counted == 1 & paste0(scores$questionnaire, ".", scores$scale) == outcome, ]
  for (factor in setdiff(factors, "block")) {
    always <- vapply(rows$participant_id, function(person) {
      its <- unique(attempts[[factor]][attempts$participant_id == person])
      if (length(its) == 1) its else NA_character_
    }, "", USE.NAMES = FALSE)
    of_condition <- attempts[[factor]][match(rows$condition, attempts$condition)]
    rows[[factor]] <- ifelse(is.na(of_condition), always, of_condition)
  }
  rows
}

# Means of covariates over the trials of each person and combination.
with_covariates <- function(data, trials, covariates, factors) {
  by <- c("participant_id", factors)
  for (covariate in covariates) {
    means <- aggregate(trials[covariate], trials[by], mean)
    data[[covariate]] <- means[[covariate]][match(combination(data, by), combination(means, by))]
  }
  data
}

show_cells <- function(id, data, value, factors) {
  if (nrow(data) == 0) return(invisible())
  at <- combinations(data, factors)
  where <- combination(data, factors)
  decimals <- decimals_of(sd(data[[value]]), 3)
  at[] <- lapply(at, as.character)
  report$cells[[id]] <- cbind(data.frame(cell = seq_len(nrow(at))), at)
  html_table(c(if (length(factors) > 0) name(factors), "n", "mean", "sd", paste(percent, "interval of the mean")),
             words = length(factors),
             caption = paste("Cells of", name(value)), lapply(seq_len(nrow(at)), function(i) {
    x <- data[[value]][where == combination(at, factors)[i]]
    half <- if (length(x) > 1) qt(0.975, length(x) - 1) * sd(x) / sqrt(length(x)) else NA
    cell <- id %.% "cell" %.% i
    c(if (length(factors) > 0) name(unlist(at[i, ])), count(cell %.% "n", length(x)),
      num(cell %.% "mean", mean(x), decimals = decimals),
      num(cell %.% "sd", sd(x), decimals = decimals), interval(cell, mean(x) - half, mean(x) + half, decimals))
  }))
}

# Pictures: the factor with most levels is the axis, all others make the panes.
axis_of <- function(data, factors) if (length(factors) > 0) factors[which.max(vapply(data[factors], nlevels, 1L))]

panes_of <- function(data, factors) {
  rest <- setdiff(factors, axis_of(data, factors))
  if (length(rest) > 0) combination(combinations(data, rest), rest) else ""
}

picture_height <- function(data, factors) {
  panes <- panes_of(data, factors)
  max(3, 2.7 * ceiling(length(panes) / columns_of(panes)))
}

# Every person as a thin line; before them means with their intervals.
plot_people <- function(data, value, factors) {
  if (nrow(data) == 0) return(invisible())
  blue <- "#1f5a85"
  axis_factor <- axis_of(data, factors)
  rest <- setdiff(factors, axis_factor)
  panes <- panes_of(data, factors)
  columns <- columns_of(panes)
  old <- panels(ceiling(length(panes) / columns), columns, c(4.2, 4.6, 1.9, 0.6))
  on.exit(par(old))
  half_width <- function(y) if (length(y) > 1) qt(0.975, length(y) - 1) * sd(y) / sqrt(length(y)) else 0
  range <- range(data[[value]], unlist(tapply(data[[value]], combination(data, factors),
    function(y) mean(y) + half_width(y) * c(-1, 1))))
  if (diff(range) == 0) range <- range + c(-0.5, 0.5)
  where <- combination(data, rest)
  marks <- if (is.null(axis_factor)) "" else levels(data[[axis_factor]])
  wrapped <- if (max(nchar(marks)) * length(marks) > 60 / columns) gsub("([_ ])", "\\1\n", marks) else marks
  lines <- max(lengths(strsplit(wrapped, "\n")), 1)
  par(mar = c(2.6 + lines, 4.6, 1.9, 0.6))
  for (pane in panes) {
    its <- data[where == pane, ]
    x <- if (is.null(axis_factor)) rep(1L, nrow(its)) else as.integer(its[[axis_factor]])
    plot(NA, xlim = c(0.6, length(marks) + 0.4), ylim = range, xaxt = "n", xlab = "", ylab = "")
    title(ylab = value, line = 3.4)
    if (!is.null(axis_factor)) title(xlab = axis_factor, line = 0.6 + lines)
    grid(NA, NULL, col = "#e4e4e4", lty = 1)
    pane_title(pane)
    axis(1, seq_along(marks), FALSE)
    axis(1, seq_along(marks), wrapped, tick = FALSE, padj = 1, line = -0.9,
         cex.axis = if (length(marks) > 6 / columns) 0.8 else 1, gap.axis = 0.1)
    for (person in unique(its$participant_id)) {
      mine <- its$participant_id == person
      lines(jitter_of(person, data) + x[mine], its[[value]][mine], col = "#00000055", type = "o", pch = 16,
            cex = 0.55)
    }
    for (i in sort(unique(x))) {
      y <- its[[value]][x == i]
      segments(i, mean(y) - half_width(y), i, mean(y) + half_width(y), col = blue, lwd = 2.5)
      points(i, mean(y), pch = 21, bg = "white", col = blue, lwd = 2, cex = 1.3)
    }
  }
}

under_picture <- function(file, column)
  para("Each thin line or point is a participant; circles are means with their ", percent, " intervals. ",
       name(column), ": ",
       name(label_of(file, column)), ".", class = "note")

# A little to the side, the same for a person everywhere, so that lines that meet can be told apart.
jitter_of <- function(person, data) {
  place <- match(person, levels(data$participant_id)) / (nlevels(data$participant_id) + 1)
  0.12 * (place - 0.5)
}

# Checks that change nothing: the test that was planned is the one that is done.
note_normal <- function(id, x, what) {
  x <- x[is.finite(x)]
  if (length(x) < 3 || length(x) > 5000 || diff(range(x)) < 1e-12) return(invisible())
  test <- shapiro.test(x)
  para("For information; no choice hangs on it. Shapiro and Wilk&rsquo;s test of ", what, ": <i>W</i> = ",
       num(id %.% "shapiro.w", test$statistic), ", <i>p</i> ", shown_p(id %.% "shapiro.p", test$p.value),
         ".", class = "note")
}

note_spheric <- function(id, fit) {
  tests <- tryCatch(without("HF eps", summary(fit))$sphericity.tests, error = function(e) NULL)
  if (is.null(tests) || nrow(tests) == 0) return(invisible())
  para("Mauchly&rsquo;s test of sphericity: ", paste0(vapply(seq_len(nrow(tests)), function(i) {
    of <- id %.% rownames(tests)[i] %.% "mauchly"
    paste0(name(gsub(":", " \u00d7 ", rownames(tests)[i])), " <i>W</i> = ", num(paste0(of, "_w"), tests[i, 1]),
           ", <i>p</i> ", shown_p(paste0(of, "_p"), tests[i, 2]))
  }, ""), collapse = "; "), ". It decides nothing: both <i>p</i> stand above.", class = "note")
}

sentence <- function(...) para("<b>To copy:</b> ", ..., class = "sentence")

# What t.test() says of two levels, or of one mean.
show_t <- function(id, test, what, effect = NULL, symbol = "g") {
  effects <- if (is.null(effect)) character() else
    estimate(id, effect[[1]], effect$CI_low, effect$CI_high, symbol)
  html_table(c("Estimate", "", paste(percent, "interval"), "<i>t</i>", "df", "<i>p</i>",
               if (length(effects) > 0) c(paste0("<i>", symbol, "</i>"), "interval")),
             list(c(what, estimate(id, if (length(test$estimate) == 2) -diff(test$estimate) else test$estimate,
                                   test$conf.int[1], test$conf.int[2]),
                    num(id %.% "t", test$statistic), degrees(id %.% "df", test$parameter),
                      p_value(id %.% "p", test$p.value), effects)))
}

# Hedges' g of t.test()'s samples; nothing where t is no number, as of values that are all alike.
effect_of <- function(test, ...) if (is.finite(test$statistic)) effectsize::hedges_g(...)

copy_t <- function(id, what) {
  effect <- if (!is.null(report$results[[id %.% "g"]]))
    paste0(", Hedges&rsquo; <i>g</i> = ", again(id %.% "g"), " ", again_interval(id %.% "g"))
  sentence(what, " was ", again(id %.% "estimate"), ", ", percent, " CI ", again_interval(id %.% "estimate"),
           ", <i>t</i>(", again(id %.% "df"), ") = ", again(id %.% "t"), ", <i>p</i> ", again_p(id %.% "p"), effect, ".")
}

# `pair`: the values at the two levels of a factor, persons in one order; `test`: what t.test() made of them.
show_paired_t <- function(id, test, pair, value, factor) if (!is.null(test)) computed(id, {
  what <- paste(name(names(pair)[1]), "&minus;", name(names(pair)[2]))
  d <- pair[[1]] - pair[[2]]
  show_t(id, test, what, effect_of(test, d))
  para("Cohen&rsquo;s <i>d<sub>z</sub></i> = ", num(id %.% "dz", mean(d) / sd(d)),
       ". With so many participants the test finds a <i>d<sub>z</sub></i> of ",
       num(id %.% "sensitivity", power.t.test(length(d), sd = 1, power = 0.8, type = "paired")$delta),
       " in ", name("80 %"), " of studies.", class = "note")
  note_normal(id, d, "the differences")
  copy_t(id, paste("The mean difference", what, "of", name(value)))
  setNames(test$p.value, factor)
})

show_welch_t <- function(id, test, pair, value, factor) if (!is.null(test)) computed(id, {
  what <- paste(name(names(pair)[1]), "&minus;", name(names(pair)[2]))
  show_t(id, test, what, effect_of(test, pair[[1]], pair[[2]], pooled_sd = FALSE))
  para("With so many participants the test finds in ", name("80 %"), " of studies a difference of ",
       num(id %.% "sensitivity", power.t.test(2 / sum(1 / lengths(pair)), sd = 1, power = 0.8)$delta),
       " standard deviations.", class = "note")
  note_normal(id, unlist(lapply(pair, function(x) x - mean(x))), "the residuals")
  copy_t(id, paste("The difference of means", what, "of", name(value)))
  setNames(test$p.value, factor)
})

show_mean <- function(id, test, data, value) if (!is.null(test)) computed(id, {
  html_table(c("", "mean", paste(percent, "interval"), "df"),
             list(c(name(value), estimate(id, test$estimate, test$conf.int[1], test$conf.int[2]),
                    degrees(id %.% "df", test$parameter))))
  logarithmic <- startsWith(value, "log10_")
  if (logarithmic)
    para("In the unit of the levels: ",
         paste(estimate(id, 10^test$estimate, 10^test$conf.int[1], 10^test$conf.int[2], "level"), collapse = " "),
         ", a geometric mean.")
  note_normal(id, data[[value]], "the values")
  shown <- paste0(id, if (logarithmic) ".level" else ".estimate")
  sentence("The ", if (logarithmic) "geometric ", "mean of ",
           name(if (logarithmic) sub("log10_", "", value) else value), " was ", again(shown),
           ", ", percent, " CI ", again_interval(shown), ", <i>n</i> = ", again(id %.% "n"), ".")
})

# Hodges and Lehmann's estimate and its interval: the median of all means of two, or of all differences between two
# samples, and the order statistic that the exact distribution of the rank sum asks for.
hodges_lehmann <- function(all, quantile) {
  all <- sort(all)
  at <- max(quantile, 1)
  list(estimate = median(all), lo = all[at], hi = all[length(all) + 1 - at])
}

# Signed ranks of differences. Rounded first, so that equal decimals are equal; zeros are dropped, ties share ranks.
signed_ranks <- function(d) {
  d <- round(d, 9)
  n <- length(d)
  walsh <- outer(d, d, "+") / 2
  test <- coin::wilcoxsign_test(d ~ rep(0, n), distribution = "exact", zero.method = "Wilcoxon")
  r <- rank(abs(d[d != 0]))
  c(hodges_lehmann(walsh[upper.tri(walsh, diag = TRUE)], qsignrank(0.025, n)),
    list(z = as.numeric(coin::statistic(test)), p = as.numeric(coin::pvalue(test)),
         r = sum(r * sign(d[d != 0])) / sum(r)))
}

rank_row <- function(id, what, test)
  c(what, estimate(id, test$estimate, test$lo, test$hi), num(id %.% "z", test$z),
    p_value(id %.% "p", test$p), num(id %.% "r", test$r))

rank_head <- c("Hodges and Lehmann&rsquo;s shift", "", paste(percent, "interval"), "<i>z</i>", "exact <i>p</i>",
               "<i>r</i>")

copy_ranks <- function(id, what)
  sentence(what, " was ", again(id %.% "estimate"), ", ", percent, " CI ", again_interval(id %.% "estimate"),
           ", <i>z</i> = ",
           again(id %.% "z"), ", exact <i>p</i> ", again_p(id %.% "p"), ", rank-biserial <i>r</i> = ",
             again(id %.% "r"), ".")

show_wilcoxon <- function(id, test, pair, value, factor) if (!is.null(test)) computed(id, {
  what <- paste(name(names(pair)[1]), "&minus;", name(names(pair)[2]))
  html_table(rank_head, list(rank_row(id, what, test)))
  copy_ranks(id, paste("The shift", what, "of", name(value)))
  setNames(test$p, factor)
})

# Ranks of two samples; rounded first, as above.
rank_sums <- function(x, y) {
  x <- round(x, 9)
  y <- round(y, 9)
  samples <- data.frame(value = c(x, y), sample = factor(rep(1:2, c(length(x), length(y)))))
  test <- coin::wilcox_test(value ~ sample, samples, distribution = "exact")
  above <- mean(outer(x, y, ">")) - mean(outer(x, y, "<"))
  c(hodges_lehmann(as.vector(outer(x, y, "-")), qwilcox(0.025, length(x), length(y))),
    list(z = as.numeric(coin::statistic(test)), p = as.numeric(coin::pvalue(test)), r = above))
}

show_mann_whitney <- show_wilcoxon

# `wide`: a column a level, a row a person.
show_friedman <- function(id, test, wide, value, factor) if (!is.null(test)) computed(id, {
  pairs <- combn(ncol(wide), 2)
  tests <- lapply(seq_len(ncol(pairs)), function(i) signed_ranks(wide[, pairs[1, i]] - wide[, pairs[2, i]]))
  holm <- p.adjust(vapply(tests, function(test) test$p, 0), "holm")
  html_table(c(rank_head, "Holm"), lapply(seq_along(tests), function(i) {
    pair <- id %.% "pair" %.% factor %.% i
    c(rank_row(pair, paste(name(colnames(wide)[pairs[1, i]]), "&minus;", name(colnames(wide)[pairs[2, i]])),
               tests[[i]]),
      p_value(pair %.% "p_holm", holm[i]))
  }))
  html_table(c("Friedman", "&chi;&sup2;", "df", "<i>p</i>", "Kendall&rsquo;s <i>W</i>"),
             list(c(name(factor), num(id %.% "chisq", test$statistic), degrees(id %.% "df", test$parameter),
                    p_value(id %.% "p", test$p.value),
                      num(id %.% "w", test$statistic / (nrow(wide) * (ncol(wide) - 1))))))
  sentence("Friedman&rsquo;s test of ", name(value), " over ", name(factor), ": &chi;&sup2;(", again(id %.% "df"),
           ") = ",
           again(id %.% "chisq"), ", <i>p</i> ", again_p(id %.% "p"), ", <i>W</i> = ", again(id %.% "w"), ".")
  setNames(test$p.value, factor)
})

# Pairs of levels, a column each: those that are planned, or all.
pairs_of <- function(levels, factor, contrasts) {
  if (is.null(contrasts)) return(combn(length(levels), 2))
  its <- Filter(function(contrast) contrast[1] == factor && all(contrast[2:3] %in% levels), contrasts)
  matrix(as.integer(unlist(lapply(its, function(contrast) match(contrast[2:3], levels)))), 2)
}

# Differences between the levels of each factor, averaged over the others; intervals are for each difference alone.
# `contrasts`: those that are planned, each as factor, level, level; none: all.
show_differences <- function(id, fit, data, factors, contrasts = NULL, ...) {
  rows <- unlist(lapply(factors, function(factor) {
    levels <- levels(data[[factor]])
    pairs <- pairs_of(levels, factor, contrasts)
    if (ncol(pairs) == 0) return(list())
    means <- suppressMessages(emmeans::emmeans(fit, factor, ...))
    weights <- lapply(seq_len(ncol(pairs)), function(i) replace(replace(numeric(length(levels)), pairs[1, i], 1),
                                                                 pairs[2, i], -1))
    these <- as.data.frame(summary(emmeans::contrast(means, weights), infer = TRUE, adjust = "none"))
    holm <- p.adjust(these$p.value, "holm")
    lapply(seq_len(nrow(these)), function(i) {
      pair <- id %.% "pair" %.% factor %.% i
      c(paste0(name(factor), ": ", name(levels[pairs[1, i]]), " &minus; ", name(levels[pairs[2, i]])),
        estimate(pair, these$estimate[i], these$lower.CL[i], these$upper.CL[i]), num(pair %.% "t", these$t.ratio[i]),
        degrees(pair %.% "df", these$df[i]), p_value(pair %.% "p", these$p.value[i]),
          p_value(pair %.% "p_holm", holm[i]))
    })
  }), recursive = FALSE)
  html_table(c("Differences of means", "", paste(percent, "interval"), "<i>t</i>", "df", "<i>p</i>", "Holm"), rows)
}

# The smallest share of variance, as F df1 / (F df1 + df2) at the noncentrality that it takes, which a test finds in 80 %
# of studies.
detectable_eta <- function(df1, df2) {
  found <- function(ncp) pf(qf(0.95, df1, df2), df1, df2, ncp, lower.tail = FALSE) - 0.8
  ncp <- uniroot(found, c(0.01, 100), extendInt = "upX", tol = 1e-10)$root
  ncp / (ncp + df2)
}

note_sensitivity <- function(id, terms, df1, df2)
  para("With so many participants the test finds in ", name("80 %"), " of studies an &eta;&sup2;<sub>p</sub> of ",
       paste0(vapply(seq_along(terms), function(i) paste0(num(id %.% terms[i] %.% "sensitivity", detectable_eta(df1[i], df2[i])),
                                                           " (", name(gsub(":", " \u00d7 ", terms[i])), ")"), ""), collapse = ", "),
       ".", class = "note")

show_anova <- function(id, fit, data, value, factors, contrasts = NULL) if (!is.null(fit)) computed(id, {
  plain <- anova(fit, correction = "none")
  corrected <- without("HF eps", anova(fit, correction = "GG"))
  terms <- rownames(plain)
  within <- names(attr(fit, "within"))
  show_differences(id, fit, data, factors, contrasts)
  spheric <- vapply(strsplit(terms, ":"), function(of) any(of %in% within), NA) & plain$`num Df` > 1
  html_table(c("Analysis of variance", "df", "<i>F</i>", "<i>p</i>", "&epsilon; (GG)", "<i>p</i> (GG)",
               "&eta;&sup2;<sub>p</sub>", "interval", "&eta;&sup2;<sub>G</sub>"),
    lapply(seq_along(terms), function(i) {
      term <- id %.% terms[i]
      eta <- effectsize::F_to_eta2(plain$F[i], plain$`num Df`[i], plain$`den Df`[i], ci = 0.95,
                                   alternative = "two.sided")
      c(name(terms[i]), paste0(degrees(term %.% "df1", plain$`num Df`[i]), ", ",
                               degrees(term %.% "df2", plain$`den Df`[i])),
        num(term %.% "F", plain$F[i]), p_value(term %.% "p", plain$`Pr(>F)`[i]),
        if (spheric[i]) c(num(term %.% "gg_epsilon", corrected$`num Df`[i] / plain$`num Df`[i]),
                          p_value(term %.% "gg_p", corrected$`Pr(>F)`[i])) else c("", ""),
        num(term %.% "pes", eta$Eta2_partial, decimals = 3), interval(term %.% "pes", eta$CI_low, eta$CI_high, 3),
        num(term %.% "ges", plain$ges[i], decimals = 3))
    }))
  note_sensitivity(id, terms, plain$`num Df`, plain$`den Df`)
  note_normal(id, residuals(fit$lm), "the residuals")
  note_spheric(id, fit)
  sentence("Analysis of variance of ", name(value), ": ", paste0(vapply(seq_along(terms), function(i) {
    term <- id %.% terms[i]
    paste0(name(gsub(":", " \u00d7 ", terms[i])), ", <i>F</i>(", again(term %.% "df1"), ", ", again(term %.% "df2"),
           ") = ",
           again(term %.% "F"), ", <i>p</i> ", again_p(term %.% "p"),
           if (spheric[i]) paste0(" (Greenhouse-Geisser: &epsilon; = ", again(term %.% "gg_epsilon"), ", <i>p</i> ",
                                  again_p(term %.% "gg_p"), ")"),
           ", &eta;&sup2;<sub>p</sub> = ", again(term %.% "pes"), " ", again_interval(term %.% "pes"))
  }, ""), collapse = "; "), ".")
  p <- ifelse(spheric, corrected$`Pr(>F)`, plain$`Pr(>F)`)
  setNames(p, terms)[terms %in% factors]
})

show_lmm <- function(id, fit, data, value, factors, contrasts = NULL) if (!is.null(fit)) computed(id, {
  if (length(factors) > 0) show_differences(id, fit, data, factors, contrasts, lmer.df = "satterthwaite")
  table <- anova(fit)
  html_table(c("Mixed model", "df", "<i>F</i>", "<i>p</i>"), lapply(seq_len(nrow(table)), function(i) {
    term <- id %.% rownames(table)[i]
    c(name(rownames(table)[i]), paste0(degrees(term %.% "df1", table$NumDF[i]), ", ",
                                       degrees(term %.% "df2", table$DenDF[i])),
      num(term %.% "F", table$`F value`[i]), p_value(term %.% "p", table$`Pr(>F)`[i]))
  }))
  spread <- as.data.frame(lme4::VarCorr(fit))$sdcor
  para("Standard deviation between participants: ", num(id %.% "sd_participants", spread[1]), "; of the residuals: ",
       num(id %.% "sd_residual", spread[2]),
         if (lme4::isSingular(fit)) "; the fit is singular: no difference between participants is left to be told",
           ".", class = "note")
  if (nrow(table) > 0) note_sensitivity(id, rownames(table), table$NumDF, table$DenDF)
  note_normal(id, residuals(fit), "the residuals")
  sentence("Mixed model of ", name(value), " with an intercept for each participant: ",
           paste0(vapply(rownames(table), function(term) {
    of <- id %.% term
    paste0(name(gsub(":", " \u00d7 ", term)), ", <i>F</i>(", again(of %.% "df1"), ", ", again(of %.% "df2"), ") = ",
           again(of %.% "F"), ", <i>p</i> ", again_p(of %.% "p"))
  }, ""), collapse = "; "), ".")
  setNames(table$`Pr(>F)`, rownames(table))[rownames(table) %in% factors]
})

# Times with time-outs are censored: proportional hazards (Cox), main effects. Within persons in strata of persons, tested
# by the ratio of likelihoods, which holds where all successes are on one side; between persons each person is a cluster,
# tested by Wald's statistic. Shows the ratios; returns p by factor.
show_hazards <- function(id, trials, within, between, covariates = character()) {
  trials[c(within, between)] <- lapply(trials[c(within, between)], droplevels)
  inside <- function(factors) {
    terms <- paste(c(factors, covariates, "strata(participant_id)"), collapse = " + ")
    without("infinite|converge", coxph(as.formula(paste("Surv(time_s, finished) ~", terms)), trials))
  }
  outside <- function(factors) {
    terms <- paste(c(factors, covariates), collapse = " + ")
    without("infinite|converge", coxph(as.formula(paste("Surv(time_s, finished) ~", terms)), trials, cluster = participant_id))
  }
  rows <- list()
  all_p <- numeric()
  infinite <- FALSE
  for (group in Filter(length, list(within, between))) {
    fit <- if (identical(group, within)) inside(group) else outside(group)
    for (factor in group) {
      levels <- levels(trials[[factor]])
      b <- coef(fit)[paste0(factor, levels[-1])]
      v <- vcov(fit)[names(b), names(b), drop = FALSE]
      finite <- abs(b) < 10 & sqrt(diag(v)) < 10
      chisq <- if (identical(group, within)) 2 * (fit$loglik[2] - likelihood(inside(setdiff(group, factor)))) else
        if (all(finite)) as.numeric(b %*% solve(v, b)) else NA
      p <- pchisq(chisq, length(b), lower.tail = FALSE)
      all_p[factor] <- p
      infinite <- infinite || any(!finite)
      for (k in seq_along(b)) {
        row <- id %.% "cox" %.% factor %.% k
        bounds <- if (finite[k]) exp(b[k] + c(-1, 1) * qnorm(0.975) * sqrt(v[k, k])) else c(NA, NA)
        rows <- c(rows, list(c(paste0(name(factor), ": ", name(levels[k + 1]), " against ", name(levels[1])),
                               num(row %.% "hr", if (finite[k]) exp(b[k]) else NA),
                               paste0("[", num(row %.% "hr.lo", bounds[1]), ", ", num(row %.% "hr.hi", bounds[2]), "]"),
                               if (k == 1) c(num(id %.% "cox" %.% factor %.% "chisq", chisq),
                                             p_value(id %.% "cox" %.% factor %.% "p", p)) else c("", ""))))
      }
    }
  }
  html_table(c("Hazard of success (Cox)", "ratio", paste(percent, "interval"), "&chi;&sup2;", "<i>p</i>"), rows)
  if (infinite) para("A ratio without a number has no end: all successes are on one side of it.", class = "note")
  all_p
}

count_timeouts <- function(id, trials, ...)
  para("Of ", count(id %.% "cox.trials", nrow(trials)), " trials ", count(id %.% "cox.timeouts", sum(trials$finished == 0)),
       " ended without success.", ...)

# The model of censored times beside a planned test of their means, and whether both say the same.
show_censored <- function(id, trials, planned, within = character(), between = character()) computed(id %.% "cox", {
  if (!is.numeric(planned)) return(invisible())
  trials <- trials[!is.na(trials$time_s), ]
  if (all(trials$finished == 1) || all(trials$finished == 0)) {
    para("No time was cut off by a time-out, or all were: a model of censored times says nothing more.", class = "note")
    return(invisible())
  }
  count_timeouts(id, trials, " The model that knows this, main effects only:")
  p <- show_hazards(id, trials, within, between)
  for (factor in names(p)) if (isTRUE((p[[factor]] < 0.05) != (planned[[factor]] < 0.05))) {
    report$warnings[[id %.% "cox" %.% factor]] <- factor
    para("The planned test and the model of censored times disagree about ", name(factor), " at the level of ",
         name("5 %"), ". Means of times say less where trials were cut off: report both.", class = "warning")
  }
})

# The same as the planned test.
show_survival <- function(id, trials, within = character(), between = character(), covariates = character()) computed(id, {
  trials <- trials[!is.na(trials$time_s), ]
  count_timeouts(id, trials)
  p <- show_hazards(id, trials, within, between, covariates)
  sentence("Hazard of success, Cox&rsquo;s model", if (length(within) > 0) " in strata of participants", ": ",
           paste0(vapply(names(p), function(factor) {
             of <- id %.% "cox" %.% factor
             paste0(name(factor), ", &chi;&sup2; = ", again(of %.% "chisq"), ", <i>p</i> ", again_p(of %.% "p"))
           }, ""), collapse = "; "), ".")
  p
})

# A cumulative link mixed model of values in order, main effects, an intercept for each person; and the same without each
# factor.
ordinal_model <- function(data, value, factors) {
  data$rank <- factor(data[[value]], ordered = TRUE)
  fit <- function(terms) ordinal::clmm(as.formula(paste("rank ~", paste(c("1", terms), collapse = " + "),
                                                        "+ (1 | participant_id)")), data, nAGQ = 9)
  list(whole = fit(factors), without = lapply(setNames(factors, factors), function(factor) fit(setdiff(factors, factor))))
}

show_ordinal <- function(id, fit, data, value, factors) if (!is.null(fit)) computed(id, {
  b <- coef(summary(fit$whole))
  rows <- unlist(lapply(factors, function(factor) {
    levels <- levels(data[[factor]])[-1]
    lapply(seq_along(levels), function(k) {
      of <- b[paste0(factor, levels[k]), ]
      row <- id %.% "odds" %.% factor %.% k
      bounds <- exp(of[1] + c(-1, 1) * qnorm(0.975) * of[2])
      c(paste0(name(factor), ": ", name(levels[k]), " against ", name(levels(data[[factor]])[1])),
        estimate(row, exp(of[1]), bounds[1], bounds[2], "ratio"), num(row %.% "z", of[3]), p_value(row %.% "p", of[4]))
    })
  }), recursive = FALSE)
  html_table(c("Odds of a higher value", "", paste(percent, "interval"), "<i>z</i>", "<i>p</i>"), rows)
  p <- vapply(factors, function(factor) {
    less <- fit$without[[factor]]
    chisq <- 2 * as.numeric(logLik(fit$whole) - logLik(less))
    df <- length(coef(fit$whole)) - length(coef(less))
    p <- pchisq(chisq, df, lower.tail = FALSE)
    at <- id %.% factor
    num(at %.% "chisq", chisq)
    degrees(at %.% "df", df)
    p_value(at %.% "p", p)
    p
  }, 0)
  sentence("Cumulative link mixed model of ", name(value), " with an intercept for each participant: ",
           paste0(vapply(factors, function(factor) {
             at <- id %.% factor
             paste0(name(factor), ", &chi;&sup2;(", again(at %.% "df"), ") = ", again(at %.% "chisq"), ", <i>p</i> ",
                    again_p(at %.% "p"))
           }, ""), collapse = "; "), ".")
  setNames(p, factors)
})

# Two one-sided t-tests: the difference lies between the bounds if both say so.
show_equivalence <- function(id, pair, value, factor, bounds, paired) computed(id, {
  test <- function(...) t.test(pair[[1]], pair[[2]], paired = paired, ...)
  above <- test(alternative = "greater", mu = bounds[1])
  below <- test(alternative = "less", mu = bounds[2])
  both <- test(conf.level = 0.9)
  difference <- if (paired) mean(pair[[1]] - pair[[2]]) else mean(pair[[1]]) - mean(pair[[2]])
  p <- max(above$p.value, below$p.value)
  what <- paste(name(names(pair)[1]), "&minus;", name(names(pair)[2]))
  html_table(c("Difference of means", "", paste(name("90 %"), "interval"), "df", "<i>t</i> above the lower bound", "<i>p</i>",
               "<i>t</i> below the upper bound", "<i>p</i>"),
             list(c(what, estimate(id, difference, both$conf.int[1], both$conf.int[2]), degrees(id %.% "df", both$parameter),
                    num(id %.% "above.t", above$statistic), p_value(id %.% "above.p", above$p.value),
                    num(id %.% "below.t", below$statistic), p_value(id %.% "below.p", below$p.value))))
  sentence("The mean difference ", what, " of ", name(value), " was ", again(id %.% "estimate"), ", ", name("90 %"), " CI ",
           again_interval(id %.% "estimate"), "; that it lies from ", num(id %.% "bound.lo", bounds[1]), " to ",
           num(id %.% "bound.hi", bounds[2]), ", as was planned to mean equal: <i>p</i> ", shown_p(id %.% "p", p), ".")
  setNames(p, factor)
})

# All p values of a family, adjusted together by Holm.
show_family <- function(family, tests) {
  p <- unlist(Filter(is.numeric, tests))
  if (length(p) == 0) return(invisible())
  adjusted <- p.adjust(p, "holm")
  html_table(c("Analysis and factor", "<i>p</i>", "Holm"), caption = paste("Family", name(family)),
             lapply(seq_along(p), function(i) {
    of <- "family" %.% family %.% names(p)[i]
    c(name(names(p)[i]), p_value(of %.% "p", p[i]), p_value(of %.% "p_holm", adjusted[i]))
  }))
}

# Of a model's maximum; of one without terms, all of the likelihood that there is.
likelihood <- function(fit) fit$loglik[length(fit$loglik)]

# What practice and the trial before did: the outcome over the place in the block, and by the condition made before,
# between trials of one person and condition.
show_position <- function(id, trials, measure) computed(id %.% "position", {
  trials <- trials[!is.na(trials[[measure]]) & !is.na(trials$order_position), ]
  several <- function(column) if (length(unique(trials[[column]])) > 1) paste(" +", column) else ""
  fit <- lm(as.formula(paste0(measure, " ~ order_position", several("participant_id"), several("condition"))), trials)
  if (df.residual(fit) < 1 || is.na(coef(fit)["order_position"]) || deviance(fit) < 1e-20) return(invisible())
  slope <- summary(fit)$coefficients["order_position", ]
  bounds <- confint(fit, "order_position")
  para("Over the block ", name(measure), " changed by ",
       paste(estimate(id %.% "position", slope[1], bounds[1], bounds[2], "slope"), collapse = " "),
       " a trial, <i>p</i> ", shown_p(id %.% "position.p", slope[4]), " (persons and conditions held).",
         class = "note")
  after <- trials[!is.na(trials$previous_condition), ]
  without_it <- lm(formula(fit), after)
  with_it <- lm(update(formula(fit), . ~ . + previous_condition), after)
  test <- if (df.residual(with_it) > 0 && deviance(with_it) > 1e-20) anova(without_it, with_it)
  if (is.null(test) || is.na(test$F[2])) return(invisible())
  para("The condition before a trial: <i>F</i>(", degrees(id %.% "carry_over.df1", test$Df[2]), ", ",
       degrees(id %.% "carry_over.df2", test$Res.Df[2]),
       ") = ", num(id %.% "carry_over.F", test$F[2]), ", <i>p</i> ",
         shown_p(id %.% "carry_over.p", test$`Pr(>F)`[2]), ".", class = "note")
})
