# Rscript report_left_out.R FOLDER TIMES: deletes cells and rows of cells_long.csv at random, so many times, and compares
# whom the folder's report_tests.R leaves out with complete.cases() on the wide table. Truth: R's reshape() and complete.cases().
arguments <- commandArgs(trailingOnly = TRUE)
setwd(arguments[1])
source("report.R")
source("report_tests.R")
whole <- read_table("cells_long.csv")
whole <- whole[whole$block == "main", ]
people <- sort(unique(whole$participant_id))
within <- c("method", "push")
value <- "time_s.restricted_mean"
set.seed(1)
wrong <- 0
some <- 0
for (time in seq_len(as.integer(arguments[2]))) {
  rows <- whole
  rows[[value]][sample(nrow(rows), sample(0:4, 1))] <- NA
  if (runif(1) < 0.5) rows <- rows[-sample(nrow(rows), sample(1:8, 1)), ]
  if (runif(1) < 0.2) rows <- rows[rows$participant_id != sample(people, 1), ]
  id <- paste0("t", time)
  data <- NULL
  capture.output(data <- means_of_people(id, rows, people, value, within = within))
  rows$cell <- paste(rows$method, rows$push)
  wide <- reshape(rows[c("participant_id", "cell", value)], idvar = "participant_id", timevar = "cell", direction = "wide")
  complete <- wide$participant_id[complete.cases(wide)]
  left_out <- report$left_out[[id]]
  if (nrow(left_out) > 0) some <- some + 1
  if (!setequal(left_out$participant_id, setdiff(people, complete)) || !setequal(levels(data$participant_id), complete) ||
      any(left_out$reason == "")) wrong <- wrong + 1
}
cat(sprintf("%d of %s times as complete.cases, %d times somebody was left out\n", time - wrong, arguments[2], some))
if (wrong > 0 || some < time / 2) quit(status = 1)
