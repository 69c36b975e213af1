# Rscript report_courses.R REPORT EXPORT: the thinned ticks of a report beside all ticks of an export of the same data.
# Truth: the export's samples: a row is a tick of a trial that counts, as a number of four bytes the same; contact begins
# where a tick has force or points in contact and the one before has not; no step is longer than it may be.
arguments <- commandArgs(trailingOnly = TRUE)
courses <- read.csv(file.path(arguments[1], "courses.csv.gz"))
trials <- read.csv(file.path(arguments[1], "trials.csv"))
counted <- trials[trials$counted == 1, ]
wrong <- character()
four_bytes <- function(x) readBin(writeBin(as.numeric(x), raw(), size = 4), "numeric", length(x), size = 4)
for (i in seq_len(nrow(counted))) {
  trial <- counted[i, ]
  rows <- courses[courses$participant_id == trial$participant_id & courses$session == trial$session &
                    courses$trial_index == trial$trial_index & courses$attempt_no == trial$attempt_no, ]
  file <- sprintf("%s_%d_t%03d_a%d.csv.gz", trial$participant_id, trial$session, trial$trial_index, trial$attempt_no)
  ticks <- read.csv(file.path(arguments[2], "samples", file))
  ticks <- ticks[ticks$tick >= trial$start_tick & ticks$tick < trial$end_tick, ]
  at <- match(round(rows$t_s * 1000) + trial$start_tick, ticks$tick)
  complain <- function(what) wrong <<- c(wrong, paste(file, what))
  if (nrow(rows) == 0 || anyNA(at)) { complain("has rows that are no ticks"); next }
  for (column in c("proxy_x_m", "proxy_y_m", "proxy_z_m", "force_x_N", "force_y_N", "force_z_N", "hand_depth_m"))
    if (!identical(four_bytes(rows[[column]]), four_bytes(ticks[[column]][at]))) complain(column)
  touches <- ticks$contacts > 0 | sqrt(ticks$force_x_N^2 + ticks$force_y_N^2 + ticks$force_z_N^2) > 1e-6 |
    sqrt(ticks$torque_x_Nm^2 + ticks$torque_y_Nm^2 + ticks$torque_z_Nm^2) > 1e-9
  begins <- touches & !c(FALSE, touches[-length(touches)])
  if (!identical(at[rows$contact_begins == 1], which(begins))) complain("begins contact elsewhere")
  if (max(diff(c(1, at))) > max(25, ceiling(nrow(ticks) / 400))) complain("has a longer step")
}
if (nrow(unique(courses[c("participant_id", "session", "trial_index", "attempt_no")])) != nrow(counted))
  wrong <- c(wrong, "other trials than those that count")
if (length(wrong) > 0) cat(wrong, sep = "\n")
cat(sprintf("%d rows of %d trials, %d faults\n", nrow(courses), nrow(counted), length(wrong)))
if (length(wrong) > 0 || nrow(courses) == 0) quit(status = 1)
