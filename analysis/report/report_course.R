# Who and what is counted, how conditions fell on places, how the loop kept time, and what nobody planned to look at.

# ---- Who and what is counted -----------------------------------------------------------------------------------------

# Why a person counts for nothing; NA: does count.
fates <- function(participants, sessions, attempts) {
  counted <- participants$participant_id %in% sessions$participant_id[sessions$counted == 1]
  begun <- participants$participant_id %in% sessions$participant_id
  reason <- ifelse(is.na(participants$status_reason), "", paste0(": ", participants$status_reason))
  ruled <- attempts[grepl("^rule ", attempts$not_counted_because), ]
  rule <- ruled$not_counted_because[match(participants$participant_id, ruled$participant_id)]
  ifelse(counted, NA, ifelse(participants$status %in% c("excluded", "withdrawn"), paste0(participants$status, reason),
                             ifelse(!is.na(rule), rule, ifelse(begun, "no session that counts", "no session begun"))))
}

show_flow <- function(participants, sessions, attempts, studied) {
  others <- table(participants$kind[participants$kind != studied])
  people <- participants[participants$kind == studied, ]
  why <- fates(people, sessions, attempts)
  reasons <- unique(why[!is.na(why)])
  html_table(c("Participants", "codes", "n"), words = 2, caption = "From enrolled to counted",
             c(list(c("Enrolled", "", count("flow.people.enrolled", nrow(people)))),
               lapply(seq_along(reasons), function(i) c(paste0("&minus; ", name(reasons[i])),
                 name(paste(people$participant_id[why %in% reasons[i]], collapse = ", ")),
                                                        count("flow.people.reason" %.% i,
                                                          sum(why %in% reasons[i])))),
               list(c("<b>Counted</b>", "", count("flow.people.counted", sum(is.na(why)))))))
  rows <- of_kind(attempts, studied)
  out <- rows$not_counted_because[rows$counted == 0]
  reasons <- sort(unique(out))
  html_table(c("Attempts at a trial", "n"), caption = "From made to counted",
             c(list(c("Made", count("flow.attempts.made", nrow(rows)))),
               lapply(seq_along(reasons), function(i) c(paste0("&minus; ", name(reasons[i])),
                 count("flow.attempts.reason" %.% i, sum(out %in% reasons[i])))),
               list(c("<b>Counted</b>", count("flow.attempts.counted", sum(rows$counted == 1))))))
  cut_off <- sessions$participant_id[sessions$kind == studied & sessions$counted == 1 & !(sessions$end_state %in% "complete")]
  if (length(cut_off) > 0) para("Counted though it did not come to its end: the session of ",
                                name(paste(cut_off, collapse = ", ")), ".")
  for (other in names(others))
    para("Left apart from all that follows: ", count("flow.apart" %.% other, others[[other]]), " of kind ",
         name(other), ".")
}

# What became otherwise than planned, as far as the program knows it.
show_deviations <- function(participants, sessions, attempts, studied, protocols) {
  plans <- jsonlite::fromJSON("plan.json", simplifyVector = FALSE)$plans
  items <- character()
  for (i in seq_along(plans)) {
    planned <- plans[[i]]$plan$participants
    counted <- length(counted_people(sessions, studied, plans[[i]]$protocol_sha256))
    if (is.numeric(planned) && planned != counted)
      items <- c(items, paste0("Planned were ", count("deviation" %.% i %.% "planned", planned),
                               " participants, counted are ",
                               count("deviation" %.% i %.% "counted", counted),
                                 if (length(plans) > 1) paste0(" (protocol ",
                                   name(substr(plans[[i]]$protocol_sha256, 1, 8)), ")"), "."))
  }
  if (length(protocols) > 1) items <- c(items,
                                        paste0("The protocol was changed: ",
                                          count("deviation.protocols", length(protocols)), " versions have data."))
  out <- participants[participants$kind == studied & participants$status %in% "excluded", ]
  if (nrow(out) > 0) items <- c(items,
                                paste0("Excluded by hand: ", paste0(name(out$participant_id), " (",
                                  name(ifelse(is.na(out$status_reason), "no reason stored", out$status_reason)), ")",
                                    collapse = ", "), "."))
  invalid <- sum(of_kind(attempts, studied)$valid == 0)
  if (invalid > 0) items <- c(items,
                              paste0("Not valid: ", count("deviation.invalid", invalid),
                                     " attempts, for reasons that stand above."))
  items <- c(items, changed_texts(protocols))
  if (length(items) == 0) return(para("Nothing that the program can tell became otherwise than planned.",
                                      class = "note"))
  html("<ul>", paste0("<li>", items, "</li>", collapse = "\n"), "</ul>")
}

# Which text is no longer as it was written, and which planned test it no longer has.
changed_texts <- function(protocols) {
  items <- character()
  for (protocol in protocols)
    if (!identical(digest::digest(file = file.path("protocol", paste0(protocol, ".toml")), algo = "sha256"), protocol))
      items <- c(items, paste0("The protocol ", name(substr(protocol, 1, 8)), " in this folder is not the one that was stored."))
  text <- knitr::current_input()
  if (is.null(text)) return(items)
  sums <- read_sums()
  if (identical(digest::digest(file = text, algo = "sha256"), sums$sum[sums$file == text])) return(items)
  items <- c(items, paste0(name(text), " was edited after it was written from the plan."))
  if (!file.exists("analyses.csv")) return(items)
  planned <- read_table("analyses.csv")
  lines <- paste(readLines(text, encoding = "UTF-8", warn = FALSE), collapse = "\n")
  for (i in seq_len(nrow(planned))) {
    call <- if (grepl("anova", planned$test[i])) "show_anova" else paste0("show_", planned$test[i])
    if (!grepl(paste0(call, "(\"a", i, "\""), lines, fixed = TRUE))
      items <- c(items, paste0("Analysis ", name(i), " no longer has the test that was planned, ", name(planned$test[i]), "."))
  }
  items
}

# How conditions fell on the places of a block: counts, and what came before.
show_balance <- function(trials) {
  if (nrow(trials) == 0) return(para("No trial counts by itself; a staircase chooses its own.", class = "note"))
  for (block in unique(trials$block)) {
    rows <- trials[trials$block == block, ]
    conditions <- sort(unique(rows$condition))
    if (length(conditions) < 2) next
    html_table(c("Condition", "trials", "mean place", "sd", "in first place", "kinds of trial before",
                 "most often the same before"),
               caption = paste("Places in block", name(block)), lapply(seq_along(conditions), function(i) {
      its <- rows[rows$condition == conditions[i], ]
      before <- its$previous_condition[!is.na(its$previous_condition)]
      id <- "balance" %.% block %.% i
      c(name(conditions[i]), count(id %.% "n", nrow(its)),
        num(id %.% "position_mean", mean(its$order_position), decimals = 1),
        num(id %.% "position_sd", sd(its$order_position), decimals = 1),
          count(id %.% "first", sum(its$order_position %in% 1)),
        count(id %.% "before", length(unique(before))),
          count(id %.% "most_before", if (length(before) > 0) max(table(before)) else 0))
    }))
  }
}

show_timing <- function(timing, presentation) {
  most <- function(x) if (all(is.na(x))) NA else max(x, na.rm = TRUE)
  loops <- unique(timing$loop)
  if (nrow(timing) > 0) html_table(c("Loop", "attempts", "ticks", "missed cycles", "samples lost",
                                     paste0("worst ", name("99th"), " percentile [&micro;s]") ,
                                       "longest tick [&micro;s]"),
    caption = "The haptic loop", lapply(loops, function(loop) {
      its <- timing[timing$loop == loop, ]
      id <- "timing" %.% loop
      c(name(loop), count(id %.% "attempts", nrow(its)), count(id %.% "ticks", sum(its$n_ticks)),
        count(id %.% "missed", sum(its$overruns)),
        count(id %.% "lost", sum(its$dropped_samples)), num(id %.% "p99_us", most(its$p99_us)),
          num(id %.% "max_us", most(its$max_us)))
    }))
  if ("virtual" %in% loops) para("In virtual time no cycle can be missed and no tick is timed: this says nothing about a device.", class = "note")
  columns <- setdiff(names(presentation)[vapply(presentation, is.numeric, NA)],
                     c("session", "trial_index", "attempt_no", "block_index"))
  columns <- columns[vapply(columns, function(column) any(!is.na(presentation[[column]])), NA)]
  if (length(columns) == 0) return(para("No pictures were timed: nobody saw them on a screen.", class = "note"))
  html_table(c("Pictures, by attempt", "median", "least", "largest"), lapply(columns, function(column) {
    x <- presentation[[column]][!is.na(presentation[[column]])]
    id <- "pictures" %.% column
    c(name(label_of("presentation.csv", column)), num(id %.% "median", median(x)),
      num(id %.% "least", min(x)), num(id %.% "largest", max(x)))
  }))
}

# ---- Exploratory -----------------------------------------------------------------------------------------------------

# A measure over the places of a block: every trial as a point, the median of each place as a line.
plot_course <- function(trials, measure) {
  trials <- trials[!is.na(trials[[measure]]) & !is.na(trials$order_position), ]
  blocks <- unique(trials$block)
  if (length(blocks) == 0) return(invisible())
  columns <- columns_of(blocks)
  old <- panels(ceiling(length(blocks) / columns), columns, c(3.6, 4.6, 1.9, 0.6))
  on.exit(par(old))
  for (block in blocks) {
    its <- trials[trials$block == block, ]
    plot(its$order_position, its[[measure]], pch = 16, cex = 0.55, col = "#00000055", xlab = "place in the block",
         ylab = "")
    title(ylab = measure, line = 3.4)
    grid(NA, NULL, col = "#e4e4e4", lty = 1)
    pane_title(block)
    middle <- tapply(its[[measure]], its$order_position, median)
    lines(as.numeric(names(middle)), middle, col = "#1f5a85", lwd = 2.2)
  }
}

course_height <- function(trials) max(3,
                                      2.7 * ceiling(length(unique(trials$block)) / columns_of(unique(trials$block))))

# Every measure in every condition of a block, mean of persons' means.
show_measures <- function(cells, columns) {
  for (block in unique(cells$block)) {
    its <- cells[cells$block == block, ]
    conditions <- unique(its$condition)
    shown <- columns[vapply(columns, function(column) any(!is.na(its[[column]])), NA)]
    if (length(shown) == 0) next
    html("<details><summary>Block ", name(block), ": means of all measures</summary>")
    for (column in shown) {
      id <- "measure" %.% block %.% column
      head <- c(name(label_of("cells_long.csv", column)), "n", "mean", "sd")
      html_table(head, lapply(seq_along(conditions), function(i) {
        x <- its[[column]][its$condition == conditions[i]]
        x <- x[!is.na(x)]
        c(name(conditions[i]), count(id %.% i %.% "n", length(x)),
          num(id %.% i %.% "mean", if (length(x) > 0) mean(x) else NA, 4), num(id %.% i %.% "sd", sd(x)))
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
  html_table(c("Questionnaire", "scale", "condition", "n", "mean", "sd"), words = 3,
             caption = "Scores of questionnaires", lapply(seq_len(nrow(what)), function(i) {
    its <- scores[scores$questionnaire == what$questionnaire[i] & scores$scale == what$scale[i] & scores$at == what$at[i], ]
    x <- tapply(its$score, its$participant_id, mean)
    id <- "score" %.% i
    c(name(unlist(what[i, ])), count(id %.% "n", length(x)), num(id %.% "mean", mean(x), decimals = 2),
      num(id %.% "sd", sd(x), decimals = 2))
  }))
}
