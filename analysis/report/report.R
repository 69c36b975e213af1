# What analysis.Rmd calls: files and their sums, numbers with an id, tables, pictures, and the words around each test.
# Every number of the report passes num() or p_value(), which write it into results.json as well.

# ---- Files -----------------------------------------------------------------------------------------------------------

of_kind <- function(table, studied) if (nrow(table) > 0) table[table$kind == studied, ] else table

# Who counts under a protocol, by code.
counted_people <- function(sessions, studied, protocol)
  sort(unique(sessions$participant_id[sessions$counted == 1 & sessions$kind == studied & sessions$protocol_sha256 == protocol]))

# Factors with the levels of the plan, in its order.
with_levels <- function(rows, levels) {
  for (factor in names(levels)) rows[[factor]] <- factor(rows[[factor]], levels = levels[[factor]])
  rows
}

# Stops if a table is not what it was when this folder was written.
check_tables <- function() {
  sums <- read.table("SHA256SUMS", col.names = c("sum", "file"), colClasses = "character", quote = "", comment.char = "")
  for (i in which(!grepl("/", sums$file) & grepl("[.]csv$", sums$file))) {
    file <- sums$file[i]
    if (!file.exists(file) || digest::digest(file = file, algo = "sha256") != sums$sum[i])
      stop(file, ": is not the file that was written into this folder: its SHA-256 differs from SHA256SUMS", call. = FALSE)
  }
}

codebook <- NULL

# A table with the types that codebook.csv gives its columns; no rows where the study has no such table.
read_table <- function(file) {
  if (is.null(codebook))
    codebook <<- read.csv("codebook.csv", colClasses = "character", na.strings = NULL, encoding = "UTF-8")
  columns <- codebook[codebook$file == file, ]
  if (!file.exists(file)) return(data.frame())
  classes <- ifelse(columns$type %in% c("text", "time"), "character", "numeric")
  read.csv(file, colClasses = classes, check.names = FALSE, encoding = "UTF-8")
}

label_of <- function(file, column) {
  row <- codebook[codebook$file == file & codebook$column == column, ]
  if (nrow(row) == 0) return(column)
  if (row$unit %in% c("", "NA")) row$label else paste0(row$label, " [", row$unit, "]")
}

# ---- Numbers ---------------------------------------------------------------------------------------------------------

report <- new.env()
report$results <- list()
report$shown <- list()
report$cells <- list()
report$left_out <- list()
report$not_computed <- list()
report$warnings <- list()

escape <- function(x) gsub("\"", "&quot;", gsub(">", "&gt;", gsub("<", "&lt;", gsub("&", "&amp;", x))))

# A word of the study: a level, a code, a column.
name <- function(x) paste0("<span class=\"name\">", escape(x), "</span>")

keep <- function(id, x, text) {
  if (!is.null(report$results[[id]])) stop("two results have the id ", id)
  report$results[[id]] <- if (length(x) == 1 && is.finite(x)) as.numeric(x) else NA_real_
  report$shown[[id]] <- paste0("<span data-result=\"", escape(id), "\">", text, "</span>")
}

# A number that was shown before, in a sentence.
again <- function(id) report$shown[[id]]

# How many decimals show so many significant digits of x.
decimals_of <- function(x, digits) {
  x <- x[is.finite(x) & x != 0]
  if (length(x) == 0) 2 else max(0, digits - 1 - floor(log10(max(abs(x)))))
}

# x as text; very small and very large ones as a power of ten.
decimal <- function(x, decimals, digits = 3) {
  if (length(x) != 1 || is.na(x)) return("&ndash;")
  if (is.infinite(x)) return(if (x > 0) "&infin;" else "&minus;&infin;")
  text <- if (x != 0 && (decimals > 6 || abs(x) >= 1e6))
    paste0(sub("e[+]?(-?)0*", "&thinsp;&times;&thinsp;10<sup>\\1", formatC(x, digits = digits - 1, format = "e")), "</sup>") else
    formatC(x, digits = decimals, format = "f")
  gsub("-", "&minus;", text)
}

# x with its id: with so many significant digits, or so many decimals.
num <- function(id, x, digits = 3, decimals = decimals_of(x, digits)) keep(id, x, decimal(unname(x), decimals, digits))

count <- function(id, n) keep(id, n, if (is.na(n)) "&ndash;" else formatC(n, format = "d"))

# Degrees of freedom: whole where they are.
degrees <- function(id, df) if (isTRUE(abs(df - round(df)) < 0.005)) keep(id, df, formatC(round(df), format = "d")) else num(id, df)

p_value <- function(id, p) keep(id, p, if (length(p) == 1 && isTRUE(p < 0.001)) "&lt;&thinsp;0.001" else
  if (length(p) == 1 && is.finite(p)) formatC(p, digits = 3, format = "f") else "&ndash;")

shown_p <- function(id, p) {
  p_value(id, p)
  again_p(id)
}

again_p <- function(id) if (isTRUE(report$results[[id]] < 0.001)) again(id) else paste0("= ", again(id))

interval <- function(id, lo, hi, decimals = decimals_of(c(lo, hi), 3))
  paste0("[", num(paste0(id, ".lo"), lo, decimals = decimals), ", ", num(paste0(id, ".hi"), hi, decimals = decimals), "]")

# An estimate and its interval, both to three digits of the interval's width.
estimate <- function(id, x, lo, hi, name = "estimate") {
  decimals <- decimals_of(if (isTRUE(hi > lo)) hi - lo else x, 3)
  c(num(paste0(id, ".", name), x, decimals = decimals), interval(paste0(id, ".", name), lo, hi, decimals))
}

again_interval <- function(id) paste0("[", again(paste0(id, ".lo")), ", ", again(paste0(id, ".hi")), "]")

percent <- "<span class=\"name\">95&thinsp;%</span>"

# ---- Page ------------------------------------------------------------------------------------------------------------

html <- function(...) cat("\n\n```{=html}\n", ..., "\n```\n\n", sep = "")
para <- function(..., class = NULL)
  html("<p", if (!is.null(class)) paste0(" class=\"", class, "\""), ">", ..., "</p>")

# `rows`: a list of character vectors; `words`: how many columns, from the left, hold words.
html_table <- function(head, rows, words = 1, caption = NULL) {
  line <- function(cells, tag) {
    class <- ifelse(seq_along(cells) <= words, "", " class=\"number\"")
    paste0("<tr>", paste0("<", tag, class, ">", cells, "</", tag, ">", collapse = ""), "</tr>\n")
  }
  html("<table>", if (!is.null(caption)) paste0("<caption>", caption, "</caption>"), "\n<thead>", line(head, "th"),
       "</thead>\n<tbody>\n", paste0(vapply(rows, line, "", tag = "td"), collapse = ""), "</tbody>\n</table>")
}

# The value of an expression, or nothing and a line that says why.
computed <- function(id, expression) {
  invisible(tryCatch(expression, error = function(e) {
    why <- gsub("[[:space:]]+", " ", conditionMessage(e))
    report$not_computed[[id]] <- why
    para("Not computed. R says: ", name(why), class = "warning")
    NULL
  }))
}

# Values of `expression` without those warnings that match `known`, about which the report has its own words.
without <- function(known, expression) {
  withCallingHandlers(expression, warning = function(w) {
    if (grepl(known, conditionMessage(w))) invokeRestart("muffleWarning")
  })
}

# What people are analysed: never several kinds together.
banner <- function(studied) {
  if (studied == "real") return(invisible())
  html("<div class=\"banner\">", if (studied == "simulated") "Simulated participants: this shows that study and analysis work, never how people behave"
       else "Pilot data: made to try the study, no result of it", "</div>\n<style>h1:not(.title)::after, h2::after { content: \"", studied, "\" }</style>")
}

# ---- Who and what is counted -----------------------------------------------------------------------------------------

# Why a person counts for nothing; NA: does count.
fates <- function(participants, sessions) {
  counted <- participants$participant_id %in% sessions$participant_id[sessions$counted == 1]
  begun <- participants$participant_id %in% sessions$participant_id
  reason <- ifelse(is.na(participants$status_reason), "", paste0(": ", participants$status_reason))
  ifelse(counted, NA, ifelse(participants$status %in% c("excluded", "withdrawn"), paste0(participants$status, reason),
                             ifelse(begun, "no session that counts", "no session begun")))
}

show_flow <- function(participants, sessions, attempts, studied) {
  others <- table(participants$kind[participants$kind != studied])
  people <- participants[participants$kind == studied, ]
  why <- fates(people, sessions)
  reasons <- unique(why[!is.na(why)])
  html_table(c("Participants", "codes", "n"), words = 2, caption = "From enrolled to counted",
             c(list(c("Enrolled", "", count("flow.people.enrolled", nrow(people)))),
               lapply(seq_along(reasons), function(i) c(paste0("&minus; ", name(reasons[i])), name(paste(people$participant_id[why %in% reasons[i]], collapse = ", ")),
                                                        count(paste0("flow.people.reason.", i), sum(why %in% reasons[i])))),
               list(c("<b>Counted</b>", "", count("flow.people.counted", sum(is.na(why)))))))
  rows <- of_kind(attempts, studied)
  out <- rows$not_counted_because[rows$counted == 0]
  reasons <- sort(unique(out))
  html_table(c("Attempts at a trial", "n"), caption = "From made to counted",
             c(list(c("Made", count("flow.attempts.made", nrow(rows)))),
               lapply(seq_along(reasons), function(i) c(paste0("&minus; ", name(reasons[i])), count(paste0("flow.attempts.reason.", i), sum(out %in% reasons[i])))),
               list(c("<b>Counted</b>", count("flow.attempts.counted", sum(rows$counted == 1))))))
  cut_off <- sessions$participant_id[sessions$kind == studied & sessions$counted == 1 & !(sessions$end_state %in% "complete")]
  if (length(cut_off) > 0) para("Counted though it did not come to its end: the session of ", name(paste(cut_off, collapse = ", ")), ".")
  for (other in names(others))
    para("Left apart from all that follows: ", count(paste0("flow.apart.", other), others[[other]]), " of kind ", name(other), ".")
}

# What became otherwise than planned, as far as the program knows it.
show_deviations <- function(participants, sessions, attempts, studied, protocols) {
  plans <- jsonlite::fromJSON("plan.json", simplifyVector = FALSE)$plans
  items <- character()
  for (i in seq_along(plans)) {
    planned <- plans[[i]]$plan$participants
    counted <- length(counted_people(sessions, studied, plans[[i]]$protocol_sha256))
    if (is.numeric(planned) && planned != counted)
      items <- c(items, paste0("Planned were ", count(paste0("deviation.", i, ".planned"), planned), " participants, counted are ",
                               count(paste0("deviation.", i, ".counted"), counted), if (length(plans) > 1) paste0(" (protocol ", name(substr(plans[[i]]$protocol_sha256, 1, 8)), ")"), "."))
  }
  if (length(protocols) > 1) items <- c(items, paste0("The protocol was changed: ", count("deviation.protocols", length(protocols)), " versions have data."))
  out <- participants[participants$kind == studied & participants$status %in% "excluded", ]
  if (nrow(out) > 0) items <- c(items, paste0("Excluded by hand: ", paste0(name(out$participant_id), " (", name(ifelse(is.na(out$status_reason), "no reason stored", out$status_reason)), ")", collapse = ", "), "."))
  invalid <- sum(of_kind(attempts, studied)$valid == 0)
  if (invalid > 0) items <- c(items, paste0("Not valid: ", count("deviation.invalid", invalid), " attempts, for reasons that stand above."))
  if (length(items) == 0) return(para("Nothing that the program can tell became otherwise than planned.", class = "note"))
  html("<ul>", paste0("<li>", items, "</li>", collapse = "\n"), "</ul>")
}

# How conditions fell on the places of a block: counts, and what came before.
show_balance <- function(trials) {
  for (block in unique(trials$block)) {
    rows <- trials[trials$block == block, ]
    conditions <- sort(unique(rows$condition))
    if (length(conditions) < 2) next
    html_table(c("Condition", "trials", "mean place", "sd", "in first place", "kinds of trial before", "most often the same before"),
               caption = paste("Places in block", name(block)), lapply(seq_along(conditions), function(i) {
      its <- rows[rows$condition == conditions[i], ]
      before <- its$previous_condition[!is.na(its$previous_condition)]
      id <- paste0("balance.", block, ".", i, ".")
      c(name(conditions[i]), count(paste0(id, "n"), nrow(its)), num(paste0(id, "position_mean"), mean(its$order_position), decimals = 1),
        num(paste0(id, "position_sd"), sd(its$order_position), decimals = 1), count(paste0(id, "first"), sum(its$order_position %in% 1)),
        count(paste0(id, "before"), length(unique(before))), count(paste0(id, "most_before"), if (length(before) > 0) max(table(before)) else 0))
    }))
  }
}

show_timing <- function(timing, presentation) {
  most <- function(x) if (all(is.na(x))) NA else max(x, na.rm = TRUE)
  loops <- unique(timing$loop)
  if (nrow(timing) > 0) html_table(c("Loop", "attempts", "ticks", "missed cycles", "samples lost", paste0("worst ", name("99th"), " percentile [&micro;s]") , "longest tick [&micro;s]"),
    caption = "The haptic loop", lapply(loops, function(loop) {
      its <- timing[timing$loop == loop, ]
      id <- paste0("timing.", loop, ".")
      c(name(loop), count(paste0(id, "attempts"), nrow(its)), count(paste0(id, "ticks"), sum(its$n_ticks)), count(paste0(id, "missed"), sum(its$overruns)),
        count(paste0(id, "lost"), sum(its$dropped_samples)), num(paste0(id, "p99_us"), most(its$p99_us)), num(paste0(id, "max_us"), most(its$max_us)))
    }))
  if ("virtual" %in% loops) para("In virtual time no cycle can be missed and no tick is timed: this says nothing about a device.", class = "note")
  columns <- setdiff(names(presentation)[vapply(presentation, is.numeric, NA)], c("session", "trial_index", "attempt_no", "block_index"))
  columns <- columns[vapply(columns, function(column) any(!is.na(presentation[[column]])), NA)]
  if (length(columns) == 0) return(para("No pictures were timed: nobody saw them on a screen.", class = "note"))
  html_table(c("Pictures, by attempt", "median", "least", "largest"), lapply(columns, function(column) {
    x <- presentation[[column]][!is.na(presentation[[column]])]
    id <- paste0("pictures.", column, ".")
    c(name(label_of("presentation.csv", column)), num(paste0(id, "median"), median(x)), num(paste0(id, "least"), min(x)), num(paste0(id, "largest"), max(x)))
  }))
}

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
# persons. Keeps the others by code, with what they lack.
means_of_people <- function(id, rows, people, value, within = character(), between = character()) {
  at <- combination(rows, within)
  wanted <- combination(combinations(rows, within), within)
  lacks <- function(person) {
    its <- rows$participant_id == person
    if (!any(its)) return("no row of this analysis")
    if (anyNA(rows[its, between])) return("no group")
    missing <- setdiff(wanted, at[its & !is.na(rows[[value]])])
    if (length(missing) == 0) NA_character_ else if (length(within) == 0) "no value" else paste("no value at", paste(missing, collapse = "; "))
  }
  why <- vapply(people, lacks, NA_character_, USE.NAMES = FALSE)
  report$left_out[[id]] <- data.frame(participant_id = people[!is.na(why)], reason = why[!is.na(why)])
  rows <- rows[rows$participant_id %in% people[is.na(why)], ]
  data <- if (nrow(rows) > 0) aggregate(rows[value], rows[c("participant_id", within, between)], mean, na.rm = TRUE) else
    rows[c("participant_id", within, between, value)]
  data[c("participant_id", within, between)] <- lapply(data[c("participant_id", within, between)], function(x) droplevels(factor(x)))
  out <- report$left_out[[id]]
  para("Analysed: ", count(paste0(id, ".n"), nlevels(data$participant_id)), " of ", count(paste0(id, ".n_counted"), length(people)),
       " counted participants.",
       if (nrow(out) > 0) paste0(" Left out: ", paste0(name(out$participant_id), " (", name(out$reason), ")", collapse = ", "), "."))
  data[do.call(order, unname(as.list(data[c("participant_id", within)]))), ]
}

show_cells <- function(id, data, value, factors) {
  if (nrow(data) == 0) return(invisible())
  at <- combinations(data, factors)
  where <- combination(data, factors)
  decimals <- decimals_of(sd(data[[value]]), 3)
  at[] <- lapply(at, as.character)
  report$cells[[id]] <- cbind(data.frame(cell = seq_len(nrow(at))), at)
  html_table(c(if (length(factors) > 0) name(factors), "n", "mean", "sd", paste(percent, "interval of the mean")), words = length(factors),
             caption = paste("Cells of", name(value)), lapply(seq_len(nrow(at)), function(i) {
    x <- data[[value]][where == combination(at, factors)[i]]
    half <- if (length(x) > 1) qt(0.975, length(x) - 1) * sd(x) / sqrt(length(x)) else NA
    cell <- paste0(id, ".cell.", i)
    c(if (length(factors) > 0) name(unlist(at[i, ])), count(paste0(cell, ".n"), length(x)), num(paste0(cell, ".mean"), mean(x), decimals = decimals),
      num(paste0(cell, ".sd"), sd(x), decimals = decimals), interval(cell, mean(x) - half, mean(x) + half, decimals))
  }))
}

# Pictures: the factor with most levels is the axis, all others make the panels.
axis_of <- function(data, factors) if (length(factors) > 0) factors[which.max(vapply(data[factors], nlevels, 1L))]

panels_of <- function(data, factors) {
  rest <- setdiff(factors, axis_of(data, factors))
  if (length(rest) > 0) combination(combinations(data, rest), rest) else ""
}

columns_of <- function(panels) if (length(panels) %in% c(2, 4)) 2 else min(3, length(panels))

picture_height <- function(data, factors) {
  panels <- panels_of(data, factors)
  max(3, 2.7 * ceiling(length(panels) / columns_of(panels)))
}

# Every person as a thin line; before them means with their intervals.
plot_people <- function(data, value, factors) {
  if (nrow(data) == 0) return(invisible())
  blue <- "#1f5a85"
  axis_factor <- axis_of(data, factors)
  rest <- setdiff(factors, axis_factor)
  panels <- panels_of(data, factors)
  columns <- columns_of(panels)
  old <- par(mfrow = c(ceiling(length(panels) / columns), columns), mar = c(4.2, 4.2, 1.9, 0.6), mgp = c(2.9, 0.5, 0),
             tcl = -0.25, las = 1, bty = "l", cex = 0.8, fg = "#444444", col.axis = "#444444", col.lab = "#444444")
  on.exit(par(old))
  half_width <- function(y) if (length(y) > 1) qt(0.975, length(y) - 1) * sd(y) / sqrt(length(y)) else 0
  range <- range(data[[value]], unlist(tapply(data[[value]], combination(data, factors), function(y) mean(y) + half_width(y) * c(-1, 1))))
  if (diff(range) == 0) range <- range + c(-0.5, 0.5)
  where <- combination(data, rest)
  marks <- if (is.null(axis_factor)) "" else levels(data[[axis_factor]])
  wrapped <- if (max(nchar(marks)) * length(marks) > 60 / columns) gsub("([_ ])", "\\1\n", marks) else marks
  lines <- max(lengths(strsplit(wrapped, "\n")), 1)
  par(mar = c(2.6 + lines, 4.6, 1.9, 0.6))
  for (panel in panels) {
    its <- data[where == panel, ]
    x <- if (is.null(axis_factor)) rep(1L, nrow(its)) else as.integer(its[[axis_factor]])
    plot(NA, xlim = c(0.6, length(marks) + 0.4), ylim = range, xaxt = "n", xlab = "", ylab = "")
    title(ylab = value, line = 3.4)
    if (!is.null(axis_factor)) title(xlab = axis_factor, line = 0.6 + lines)
    grid(NA, NULL, col = "#e4e4e4", lty = 1)
    title(main = panel, font.main = 1, cex.main = 1, adj = 0, line = 0.5)
    axis(1, seq_along(marks), FALSE)
    axis(1, seq_along(marks), wrapped, tick = FALSE, padj = 1, line = -0.9, cex.axis = if (length(marks) > 6 / columns) 0.8 else 1, gap.axis = 0.1)
    for (person in unique(its$participant_id)) {
      mine <- its$participant_id == person
      lines(jitter_of(person, data) + x[mine], its[[value]][mine], col = "#00000055", type = "o", pch = 16, cex = 0.55)
    }
    for (i in sort(unique(x))) {
      y <- its[[value]][x == i]
      segments(i, mean(y) - half_width(y), i, mean(y) + half_width(y), col = blue, lwd = 2.5)
      points(i, mean(y), pch = 21, bg = "white", col = blue, lwd = 2, cex = 1.3)
    }
  }
}

under_picture <- function(file, column)
  para("Each thin line or point is a participant; circles are means with their ", percent, " intervals. ", name(column), ": ",
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
       num(paste0(id, ".shapiro.w"), test$statistic), ", <i>p</i> ", shown_p(paste0(id, ".shapiro.p"), test$p.value), ".", class = "note")
}

note_spheric <- function(id, fit) {
  tests <- tryCatch(without("HF eps", summary(fit))$sphericity.tests, error = function(e) NULL)
  if (is.null(tests) || nrow(tests) == 0) return(invisible())
  para("Mauchly&rsquo;s test of sphericity: ", paste0(vapply(seq_len(nrow(tests)), function(i) {
    of <- paste0(id, ".", rownames(tests)[i], ".mauchly")
    paste0(name(gsub(":", " \u00d7 ", rownames(tests)[i])), " <i>W</i> = ", num(paste0(of, "_w"), tests[i, 1]), ", <i>p</i> ", shown_p(paste0(of, "_p"), tests[i, 2]))
  }, ""), collapse = "; "), ". It decides nothing: both <i>p</i> stand above.", class = "note")
}

sentence <- function(...) para("<b>To copy:</b> ", ..., class = "sentence")

# What t.test() says of two levels, or of one mean.
show_t <- function(id, test, what, effect = NULL, symbol = "g") {
  effects <- if (is.null(effect)) character() else
    estimate(id, effect[[1]], effect$CI_low, effect$CI_high, symbol)
  html_table(c("Estimate", "", paste(percent, "interval"), "<i>t</i>", "df", "<i>p</i>", if (length(effects) > 0) c(paste0("<i>", symbol, "</i>"), "interval")),
             list(c(what, estimate(id, if (length(test$estimate) == 2) -diff(test$estimate) else test$estimate, test$conf.int[1], test$conf.int[2]),
                    num(paste0(id, ".t"), test$statistic), degrees(paste0(id, ".df"), test$parameter), p_value(paste0(id, ".p"), test$p.value), effects)))
}

copy_t <- function(id, what)
  sentence(what, " was ", again(paste0(id, ".estimate")), ", ", percent, " CI ", again_interval(paste0(id, ".estimate")), ", <i>t</i>(",
           again(paste0(id, ".df")), ") = ", again(paste0(id, ".t")), ", <i>p</i> ", again_p(paste0(id, ".p")), ", Hedges&rsquo; <i>g</i> = ",
           again(paste0(id, ".g")), " ", again_interval(paste0(id, ".g")), ".")

# `pair`: the values at the two levels of a factor, persons in one order; `test`: what t.test() made of them.
show_paired_t <- function(id, test, pair, value, factor) if (!is.null(test)) computed(id, {
  what <- paste(name(names(pair)[1]), "&minus;", name(names(pair)[2]))
  d <- pair[[1]] - pair[[2]]
  show_t(id, test, what, effectsize::hedges_g(d))
  para("Cohen&rsquo;s <i>d<sub>z</sub></i> = ", num(paste0(id, ".dz"), mean(d) / sd(d)),
       ". With so many participants the test finds a <i>d<sub>z</sub></i> of ",
       num(paste0(id, ".sensitivity"), power.t.test(length(d), sd = 1, power = 0.8, type = "paired")$delta),
       " in ", name("80 %"), " of studies.", class = "note")
  note_normal(id, d, "the differences")
  copy_t(id, paste("The mean difference", what, "of", name(value)))
  setNames(test$p.value, factor)
})

show_welch_t <- function(id, test, pair, value, factor) if (!is.null(test)) computed(id, {
  what <- paste(name(names(pair)[1]), "&minus;", name(names(pair)[2]))
  show_t(id, test, what, effectsize::hedges_g(pair[[1]], pair[[2]], pooled_sd = FALSE))
  note_normal(id, unlist(lapply(pair, function(x) x - mean(x))), "the residuals")
  copy_t(id, paste("The difference of means", what, "of", name(value)))
  setNames(test$p.value, factor)
})

show_mean <- function(id, test, data, value) if (!is.null(test)) computed(id, {
  html_table(c("", "mean", paste(percent, "interval"), "df"),
             list(c(name(value), estimate(id, test$estimate, test$conf.int[1], test$conf.int[2]), degrees(paste0(id, ".df"), test$parameter))))
  logarithmic <- startsWith(value, "log10_")
  if (logarithmic)
    para("In the unit of the levels: ", paste(estimate(id, 10^test$estimate, 10^test$conf.int[1], 10^test$conf.int[2], "level"), collapse = " "),
         ", a geometric mean.")
  note_normal(id, data[[value]], "the values")
  shown <- paste0(id, if (logarithmic) ".level" else ".estimate")
  sentence("The ", if (logarithmic) "geometric ", "mean of ", name(if (logarithmic) sub("log10_", "", value) else value), " was ", again(shown),
           ", ", percent, " CI ", again_interval(shown), ", <i>n</i> = ", again(paste0(id, ".n")), ".")
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
    list(z = as.numeric(coin::statistic(test)), p = as.numeric(coin::pvalue(test)), r = sum(r * sign(d[d != 0])) / sum(r)))
}

rank_row <- function(id, what, test)
  c(what, estimate(id, test$estimate, test$lo, test$hi), num(paste0(id, ".z"), test$z),
    p_value(paste0(id, ".p"), test$p), num(paste0(id, ".r"), test$r))

rank_head <- c("Hodges and Lehmann&rsquo;s shift", "", paste(percent, "interval"), "<i>z</i>", "exact <i>p</i>", "<i>r</i>")

copy_ranks <- function(id, what)
  sentence(what, " was ", again(paste0(id, ".estimate")), ", ", percent, " CI ", again_interval(paste0(id, ".estimate")), ", <i>z</i> = ",
           again(paste0(id, ".z")), ", exact <i>p</i> ", again_p(paste0(id, ".p")), ", rank-biserial <i>r</i> = ", again(paste0(id, ".r")), ".")

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
    pair <- paste0(id, ".pair.", factor, ".", i)
    c(rank_row(pair, paste(name(colnames(wide)[pairs[1, i]]), "&minus;", name(colnames(wide)[pairs[2, i]])), tests[[i]]),
      p_value(paste0(pair, ".p_holm"), holm[i]))
  }))
  html_table(c("Friedman", "&chi;&sup2;", "df", "<i>p</i>", "Kendall&rsquo;s <i>W</i>"),
             list(c(name(factor), num(paste0(id, ".chisq"), test$statistic), degrees(paste0(id, ".df"), test$parameter),
                    p_value(paste0(id, ".p"), test$p.value), num(paste0(id, ".w"), test$statistic / (nrow(wide) * (ncol(wide) - 1))))))
  sentence("Friedman&rsquo;s test of ", name(value), " over ", name(factor), ": &chi;&sup2;(", again(paste0(id, ".df")), ") = ",
           again(paste0(id, ".chisq")), ", <i>p</i> ", again_p(paste0(id, ".p")), ", <i>W</i> = ", again(paste0(id, ".w")), ".")
  setNames(test$p.value, factor)
})

# Differences between the levels of each factor, averaged over the others; intervals are for each difference alone.
show_differences <- function(id, fit, data, factors, ...) {
  rows <- unlist(lapply(factors, function(factor) {
    levels <- levels(data[[factor]])
    pairs <- combn(length(levels), 2)
    means <- suppressMessages(emmeans::emmeans(fit, factor, ...))
    these <- as.data.frame(summary(emmeans::contrast(means, "pairwise"), infer = TRUE, adjust = "none"))
    holm <- p.adjust(these$p.value, "holm")
    lapply(seq_len(nrow(these)), function(i) {
      pair <- paste0(id, ".pair.", factor, ".", i)
      c(paste0(name(factor), ": ", name(levels[pairs[1, i]]), " &minus; ", name(levels[pairs[2, i]])),
        estimate(pair, these$estimate[i], these$lower.CL[i], these$upper.CL[i]), num(paste0(pair, ".t"), these$t.ratio[i]),
        degrees(paste0(pair, ".df"), these$df[i]), p_value(paste0(pair, ".p"), these$p.value[i]), p_value(paste0(pair, ".p_holm"), holm[i]))
    })
  }), recursive = FALSE)
  html_table(c("Differences of means", "", paste(percent, "interval"), "<i>t</i>", "df", "<i>p</i>", "Holm"), rows)
}

show_anova <- function(id, fit, data, value, factors) if (!is.null(fit)) computed(id, {
  plain <- anova(fit, correction = "none")
  corrected <- without("HF eps", anova(fit, correction = "GG"))
  terms <- rownames(plain)
  within <- names(attr(fit, "within"))
  show_differences(id, fit, data, factors)
  spheric <- vapply(strsplit(terms, ":"), function(of) any(of %in% within), NA) & plain$`num Df` > 1
  html_table(c("Analysis of variance", "df", "<i>F</i>", "<i>p</i>", "&epsilon; (GG)", "<i>p</i> (GG)", "&eta;&sup2;<sub>p</sub>", "interval", "&eta;&sup2;<sub>G</sub>"),
    lapply(seq_along(terms), function(i) {
      term <- paste0(id, ".", terms[i])
      eta <- effectsize::F_to_eta2(plain$F[i], plain$`num Df`[i], plain$`den Df`[i], ci = 0.95, alternative = "two.sided")
      c(name(terms[i]), paste0(degrees(paste0(term, ".df1"), plain$`num Df`[i]), ", ", degrees(paste0(term, ".df2"), plain$`den Df`[i])),
        num(paste0(term, ".F"), plain$F[i]), p_value(paste0(term, ".p"), plain$`Pr(>F)`[i]),
        if (spheric[i]) c(num(paste0(term, ".gg_epsilon"), corrected$`num Df`[i] / plain$`num Df`[i]), p_value(paste0(term, ".gg_p"), corrected$`Pr(>F)`[i])) else c("", ""),
        num(paste0(term, ".pes"), eta$Eta2_partial, decimals = 3), interval(paste0(term, ".pes"), eta$CI_low, eta$CI_high, 3),
        num(paste0(term, ".ges"), plain$ges[i], decimals = 3))
    }))
  note_normal(id, residuals(fit$lm), "the residuals")
  note_spheric(id, fit)
  sentence("Analysis of variance of ", name(value), ": ", paste0(vapply(seq_along(terms), function(i) {
    term <- paste0(id, ".", terms[i])
    paste0(name(gsub(":", " \u00d7 ", terms[i])), ", <i>F</i>(", again(paste0(term, ".df1")), ", ", again(paste0(term, ".df2")), ") = ",
           again(paste0(term, ".F")), ", <i>p</i> ", again_p(paste0(term, ".p")),
           if (spheric[i]) paste0(" (Greenhouse-Geisser: &epsilon; = ", again(paste0(term, ".gg_epsilon")), ", <i>p</i> ", again_p(paste0(term, ".gg_p")), ")"),
           ", &eta;&sup2;<sub>p</sub> = ", again(paste0(term, ".pes")), " ", again_interval(paste0(term, ".pes")))
  }, ""), collapse = "; "), ".")
  p <- ifelse(spheric, corrected$`Pr(>F)`, plain$`Pr(>F)`)
  setNames(p, terms)[terms %in% factors]
})

show_lmm <- function(id, fit, data, value, factors) if (!is.null(fit)) computed(id, {
  if (length(factors) > 0) show_differences(id, fit, data, factors, lmer.df = "satterthwaite")
  table <- anova(fit)
  html_table(c("Mixed model", "df", "<i>F</i>", "<i>p</i>"), lapply(seq_len(nrow(table)), function(i) {
    term <- paste0(id, ".", rownames(table)[i])
    c(name(rownames(table)[i]), paste0(degrees(paste0(term, ".df1"), table$NumDF[i]), ", ", degrees(paste0(term, ".df2"), table$DenDF[i])),
      num(paste0(term, ".F"), table$`F value`[i]), p_value(paste0(term, ".p"), table$`Pr(>F)`[i]))
  }))
  spread <- as.data.frame(lme4::VarCorr(fit))$sdcor
  para("Standard deviation between participants: ", num(paste0(id, ".sd_participants"), spread[1]), "; of the residuals: ",
       num(paste0(id, ".sd_residual"), spread[2]), if (lme4::isSingular(fit)) "; the fit is singular: no difference between participants is left to be told", ".", class = "note")
  note_normal(id, residuals(fit), "the residuals")
  sentence("Mixed model of ", name(value), " with an intercept for each participant: ", paste0(vapply(rownames(table), function(term) {
    of <- paste0(id, ".", term)
    paste0(name(gsub(":", " \u00d7 ", term)), ", <i>F</i>(", again(paste0(of, ".df1")), ", ", again(paste0(of, ".df2")), ") = ",
           again(paste0(of, ".F")), ", <i>p</i> ", again_p(paste0(of, ".p")))
  }, ""), collapse = "; "), ".")
  setNames(table$`Pr(>F)`, rownames(table))[rownames(table) %in% factors]
})

ratio_interval <- function(id, bounds) paste0("[", num(paste0(id, ".lo"), bounds[1]), ", ", num(paste0(id, ".hi"), bounds[2]), "]")

# Times with time-outs are censored: a model that knows it beside the planned one. Proportional hazards (Cox), stratified
# by person where the factor varies within persons; each person is a cluster where it does not.
show_censored <- function(id, trials, planned, within = character(), between = character()) computed(paste0(id, ".cox"), {
  if (!is.numeric(planned)) return(invisible())
  trials <- trials[!is.na(trials$time_s), ]
  if (all(trials$finished == 1) || all(trials$finished == 0)) {
    para("No time was cut off by a time-out, or all were: a model of censored times says nothing more.", class = "note")
    return(invisible())
  }
  trials[c(within, between)] <- lapply(trials[c(within, between)], droplevels)
  rows <- list()
  for (group in list(within, between)) {
    if (length(group) == 0) next
    outcome <- "survival::Surv(time_s, finished) ~ "
    model <- paste0(outcome, paste0("`", group, "`", collapse = " + "), if (identical(group, within)) " + strata(participant_id)")
    fit <- function(model) without("infinite|converge", if (identical(group, within)) survival::coxph(as.formula(model), trials, ties = "efron") else
      survival::coxph(as.formula(model), trials, cluster = participant_id))
    full <- fit(model)
    for (factor in group) {
      its <- which(startsWith(names(coef(full)), factor) | startsWith(names(coef(full)), paste0("`", factor)))
      wald <- as.numeric(t(coef(full)[its]) %*% solve(vcov(full)[its, its, drop = FALSE], coef(full)[its]))
      p <- pchisq(wald, length(its), lower.tail = FALSE)
      bounds <- suppressWarnings(confint(full))
      for (k in seq_along(its)) {
        row <- paste0(id, ".cox.", factor, ".", k)
        rows <- c(rows, list(c(paste0(name(factor), ": ", name(levels(trials[[factor]])[k + 1]), " against ", name(levels(trials[[factor]])[1])),
          num(paste0(row, ".hr"), exp(coef(full)[its[k]])), ratio_interval(paste0(row, ".hr"), exp(bounds[its[k], ])),
          if (k == 1) c(num(paste0(id, ".cox.", factor, ".chisq"), wald), p_value(paste0(id, ".cox.", factor, ".p"), p)) else c("", ""))))
      }
      if (isTRUE((p < 0.05) != (planned[[factor]] < 0.05))) report$warnings[[paste0(id, ".cox.", factor)]] <- factor
    }
  }
  para("Of ", count(paste0(id, ".cox.trials"), nrow(trials)), " trials ", count(paste0(id, ".cox.timeouts"), sum(trials$finished == 0)),
       " ended without success. The model that knows this, main effects only:")
  html_table(c("Hazard of success (Cox)", "ratio", paste(percent, "interval"), "&chi;&sup2;", "<i>p</i>"), rows)
  for (factor in c(within, between)) if (!is.null(report$warnings[[paste0(id, ".cox.", factor)]]))
    para("The planned test and the model of censored times disagree about ", name(factor), " at the level of ", name("5 %"),
         ": means of times say less than what was seen. Report both.", class = "warning")
})

# What practice and the trial before did: the outcome over the place in the block, and by the condition made before,
# between trials of one person and condition.
show_position <- function(id, trials, measure) computed(paste0(id, ".position"), {
  trials <- trials[!is.na(trials[[measure]]) & !is.na(trials$order_position), ]
  several <- function(column) if (length(unique(trials[[column]])) > 1) paste(" +", column) else ""
  fit <- lm(as.formula(paste0(measure, " ~ order_position", several("participant_id"), several("condition"))), trials)
  if (df.residual(fit) < 1 || is.na(coef(fit)["order_position"]) || deviance(fit) < 1e-20) return(invisible())
  slope <- summary(fit)$coefficients["order_position", ]
  bounds <- confint(fit, "order_position")
  para("Over the block ", name(measure), " changed by ", paste(estimate(paste0(id, ".position"), slope[1], bounds[1], bounds[2], "slope"), collapse = " "),
       " a trial, <i>p</i> ", shown_p(paste0(id, ".position.p"), slope[4]), " (persons and conditions held).", class = "note")
  after <- trials[!is.na(trials$previous_condition), ]
  without_it <- lm(formula(fit), after)
  with_it <- lm(update(formula(fit), . ~ . + previous_condition), after)
  test <- if (df.residual(with_it) > 0 && deviance(with_it) > 1e-20) anova(without_it, with_it)
  if (is.null(test) || is.na(test$F[2])) return(invisible())
  para("The condition before a trial: <i>F</i>(", degrees(paste0(id, ".carry_over.df1"), test$Df[2]), ", ", degrees(paste0(id, ".carry_over.df2"), test$Res.Df[2]),
       ") = ", num(paste0(id, ".carry_over.F"), test$F[2]), ", <i>p</i> ", shown_p(paste0(id, ".carry_over.p"), test$`Pr(>F)`[2]), ".", class = "note")
})

# ---- Exploratory -----------------------------------------------------------------------------------------------------

# A measure over the places of a block: every trial as a point, the median of each place as a line.
plot_course <- function(trials, measure) {
  trials <- trials[!is.na(trials[[measure]]) & !is.na(trials$order_position), ]
  blocks <- unique(trials$block)
  if (length(blocks) == 0) return(invisible())
  columns <- columns_of(blocks)
  old <- par(mfrow = c(ceiling(length(blocks) / columns), columns), mar = c(3.6, 4.6, 1.9, 0.6), mgp = c(2.3, 0.5, 0), tcl = -0.25, las = 1,
             bty = "l", cex = 0.8, fg = "#444444", col.axis = "#444444", col.lab = "#444444")
  on.exit(par(old))
  for (block in blocks) {
    its <- trials[trials$block == block, ]
    plot(its$order_position, its[[measure]], pch = 16, cex = 0.55, col = "#00000055", xlab = "place in the block", ylab = "")
    title(ylab = measure, line = 3.4)
    grid(NA, NULL, col = "#e4e4e4", lty = 1)
    title(main = block, font.main = 1, cex.main = 1, adj = 0, line = 0.5)
    middle <- tapply(its[[measure]], its$order_position, median)
    lines(as.numeric(names(middle)), middle, col = "#1f5a85", lwd = 2.2)
  }
}

course_height <- function(trials) max(3, 2.7 * ceiling(length(unique(trials$block)) / columns_of(unique(trials$block))))

# Every measure in every condition of a block, mean of persons' means.
show_measures <- function(cells, columns) {
  for (block in unique(cells$block)) {
    its <- cells[cells$block == block, ]
    conditions <- unique(its$condition)
    shown <- columns[vapply(columns, function(column) any(!is.na(its[[column]])), NA)]
    if (length(shown) == 0) next
    html("<details><summary>Block ", name(block), ": means of all measures</summary>")
    for (column in shown) {
      id <- paste0("measure.", block, ".", column, ".")
      html_table(c(label_of("cells_long.csv", column), "n", "mean", "sd"), lapply(seq_along(conditions), function(i) {
        x <- its[[column]][its$condition == conditions[i]]
        x <- x[!is.na(x)]
        c(name(conditions[i]), count(paste0(id, i, ".n"), length(x)), num(paste0(id, i, ".mean"), if (length(x) > 0) mean(x) else NA, 4), num(paste0(id, i, ".sd"), sd(x)))
      }))
    }
    html("</details>")
  }
}

show_scores <- function(scores) {
  scores <- scores[scores$counted == 1 & !is.na(scores$score), ]
  if (nrow(scores) == 0) return(invisible())
  scores$at <- ifelse(is.na(scores$condition), "", scores$condition)
  what <- unique(scores[c("questionnaire", "scale", "at")])
  html_table(c("Questionnaire", "scale", "condition", "n", "mean", "sd"), words = 3, caption = "Scores of questionnaires", lapply(seq_len(nrow(what)), function(i) {
    its <- scores[scores$questionnaire == what$questionnaire[i] & scores$scale == what$scale[i] & scores$at == what$at[i], ]
    x <- tapply(its$score, its$participant_id, mean)
    id <- paste0("score.", i, ".")
    c(name(unlist(what[i, ])), count(paste0(id, "n"), length(x)), num(paste0(id, "mean"), mean(x), decimals = 2), num(paste0(id, "sd"), sd(x), decimals = 2))
  }))
}

# ---- Programs --------------------------------------------------------------------------------------------------------

show_programs <- function() {
  used <- sort(loadedNamespaces())
  para("Computed by ", name(R.version.string), " with ", name(paste(vapply(used, function(package) paste(package, packageVersion(package)), ""), collapse = ", ")), ".", class = "note")
}

# ---- results.json ----------------------------------------------------------------------------------------------------

write_results <- function(studied) {
  for (id in names(report$not_computed)) base::message("not computed: ", id, ": ", report$not_computed[[id]])
  text <- jsonlite::toJSON(list(kind = studied, results = report$results, cells = report$cells, left_out = report$left_out,
                                not_computed = report$not_computed, disagreements = report$warnings),
                           auto_unbox = TRUE, digits = I(17), na = "null", null = "null", pretty = TRUE)
  writeLines(text, "results.json", useBytes = TRUE)
}
