# Runs every analysis that an export plans (analyses.csv) with base R on the exported tables, as an analyst would, and
# says whom each keeps: Rscript planned_analyses.R FOLDER. Exit code 1 if one drops a participant who counts.
folder <- commandArgs(trailingOnly = TRUE)[1]
table <- function(file) read.csv(file.path(folder, file), stringsAsFactors = FALSE)

people <- unique(subset(table("sessions.csv"), counted == 1)$participant_id)
analyses <- table("analyses.csv")
trials <- table("trials.csv")
stopifnot(c("r_formula", "r_call") %in% names(analyses))
dropped <- nrow(analyses) == 0
for (i in seq_len(nrow(analyses))) {
  planned <- analyses[i, ]
  rows <- subset(table(planned$file), protocol_sha256 == planned$protocol_sha256)
  if (!is.na(planned$staircase)) rows <- subset(rows, staircase == planned$staircase)
  if (!is.na(planned$block)) rows <- subset(rows, block == planned$block)
  factors <- if (is.na(planned$factors) || planned$factors == "") character() else strsplit(planned$factors, ";")[[1]]
  if (planned$file == "questionnaire_scores.csv") {  # levels are those of the condition that a form is about
    rows <- subset(rows, counted == 1 & paste0(questionnaire, ".", scale) == planned$outcome)
    for (f in setdiff(factors, "block")) rows[[f]] <- trials[[f]][match(rows$condition, trials$condition)]
  }
  by <- lapply(rows[c("participant_id", factors)], factor)
  cells <- aggregate(rows[planned$value_column], by, mean, na.rm = TRUE)
  cells <- cells[complete.cases(cells), ]
  each <- tapply(cells[[planned$value_column]], cells$participant_id, length)
  kept <- names(each)[!is.na(each) & each == max(each, na.rm = TRUE)]
  data <- droplevels(cells[cells$participant_id %in% kept, ])
  if (planned$test == "lmm") {  # base R has none: its call and its fixed part
    stopifnot(identical(parse(text = planned$r_call)[[1]][[1]], quote(lme4::lmer)))
    fit <- aov(as.formula(sub(" + (1 | participant_id)", "", planned$r_formula, fixed = TRUE)), data = data)
  } else {
    fit <- eval(parse(text = planned$r_call))
  }
  if (inherits(fit, "htest")) stopifnot(is.finite(fit$p.value))
  if (planned$test %in% c("paired_t", "wilcoxon")) stopifnot(grepl("^Paired|signed rank", fit$method))
  cat(sprintf("%s %s %s: kept %d of %d\n", planned$analysis, planned$value_column,
              ifelse(is.na(planned$block), planned$staircase, planned$block), length(kept), length(people)))
  if (length(kept) < length(people) || planned$n_complete != length(kept)) dropped <- TRUE
}
if (dropped) quit(status = 1)
