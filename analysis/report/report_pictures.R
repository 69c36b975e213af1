# Pictures of trials, sessions and forms: what happened, with no test. Axes are named by codebook.csv.

# ---- Courses of a trial ----------------------------------------------------------------------------------------------

attempt_of <- function(rows) paste(rows$participant_id, rows$session, rows$trial_index, rows$attempt_no)

# The recorded ticks of the trials that count, with block and condition; `since`: time since the trial's first contact.
read_courses <- function(trials) {
  rows <- read_table("courses.csv.gz")
  if (nrow(rows) == 0) return(rows)
  rows$trial <- attempt_of(rows)
  at <- match(rows$trial, attempt_of(trials))
  rows <- cbind(rows, trials[at, c("block", "condition", "protocol_sha256")])[!is.na(at), ]
  begins <- rows[rows$contact_begins == 1, ]
  rows$since <- rows$t_s - tapply(begins$t_s, begins$trial, min)[rows$trial]
  rows$force <- sqrt(rows$force_x_N^2 + rows$force_y_N^2 + rows$force_z_N^2)
  rows
}

# Quartiles of a quantity over trials at common times, as long as half of them go on.
quartiles_of <- function(rows, quantity, times) {
  values <- vapply(split(rows, rows$trial), function(its)
    if (nrow(its) < 2) rep(NA_real_, length(times)) else
      approx(its$since, its[[quantity]], times, ties = "ordered")$y, times)
  values <- matrix(values, length(times))
  enough <- rowSums(!is.na(values)) >= ncol(values) / 2
  quartiles <- apply(values[enough, , drop = FALSE], 1, quantile, c(0.25, 0.5, 0.75), na.rm = TRUE)
  list(times = times[enough], low = quartiles[1, ], middle = quartiles[2, ], high = quartiles[3, ])
}

course_rows <- function(conditions) ceiling(length(conditions) / 2)
courses_height <- function(rows) max(1, 0.5 + 1.75 * course_rows(unique(rows$condition)))

# Depth and force of each condition of a block over the time since contact.
plot_courses <- function(rows) {
  rows <- rows[!is.na(rows$since), ]
  if (nrow(rows) == 0) return(para("Nothing was touched.", class = "note"))
  conditions <- sort(unique(rows$condition))
  times <- seq(-1, max(0.5, quantile(tapply(rows$since, rows$trial, max), 0.75)), length.out = 200)
  quantities <- c("hand_depth_m", "force")
  drawn <- lapply(setNames(quantities, quantities), function(quantity)
    lapply(split(rows, rows$condition)[conditions], quartiles_of, quantity, times))
  tops <- vapply(drawn, function(all) max(0, unlist(lapply(all, `[[`, "high"))), 0)
  old <- panels(course_rows(conditions), min(4, 2 * length(conditions)), c(2.4, 4.3, 1.7, 0.4),
                below = 1.4)
  on.exit(par(old))
  for (condition in conditions) for (quantity in quantities) {
    its <- drawn[[quantity]][[condition]]
    top <- if (tops[[quantity]] > 0) tops[[quantity]] else 1
    plot(NA, xlim = range(times), ylim = c(-0.12, 1) * top, xlab = "", ylab = "")
    abline(v = 0, col = "#b35900", lty = 3)
    polygon(c(its$times, rev(its$times)), c(its$low, rev(its$high)), col = "#1f5a8533", border = NA)
    lines(its$times, its$middle, col = "#1f5a85", lwd = 1.8)
    mine <- rows[rows$condition == condition & rows$contact_begins == 1 & rows$since <= max(times), ]
    segments(mine$since, -0.12 * top, mine$since, -0.04 * top, col = "#00000033")
    title(ylab = if (quantity == "force") paste0("force [", unit_of("courses.csv.gz", "force_x_N"), "]") else
      paste0("depth [", unit_of("courses.csv.gz", quantity), "]"), line = 3.1)
    if (quantity == "hand_depth_m") pane_title(condition, 2)
  }
  mtext(paste0("time since the first contact [", unit_of("courses.csv.gz", "t_s"), "]"), 1, outer = TRUE, cex = 0.66,
        col = "#444444", line = 0.2)
  para("Of the trials of a condition the median and, shaded, the quartiles, as long as half of them go on; strokes below: ",
       "contact begins. Depth: ", name(label_of("courses.csv.gz", "hand_depth_m")), ".", class = "note")
}

# ---- Paths -----------------------------------------------------------------------------------------------------------

# For each condition of a plan the pose of the part that its task is about, or nothing.
targets_of <- function(protocol) {
  plans <- jsonlite::fromJSON("plan.json", simplifyVector = FALSE)$plans
  plan <- Filter(function(of) of$protocol_sha256 == protocol, plans)[[1]]$plan
  poses <- lapply(plan$conditions, function(condition) {
    target <- condition$params$task$target
    part <- Filter(function(part) identical(part$name, target), condition$params$parts)
    if (length(part) == 1) part[[1]]$pose
  })
  setNames(poses, vapply(plan$conditions, `[[`, "", "condition"))
}

# Points, a row each, in the frame of a pose.
in_frame_of <- function(points, pose) {
  q <- unlist(pose$quaternion_wxyz)
  w <- q[1]; x <- q[2]; y <- q[3]; z <- q[4]
  rotation <- matrix(c(1 - 2 * (y^2 + z^2), 2 * (x * y + w * z), 2 * (x * z - w * y),
                       2 * (x * y - w * z), 1 - 2 * (x^2 + z^2), 2 * (y * z + w * x),
                       2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x^2 + y^2)), 3)
  sweep(points, 2, unlist(pose$position_m)) %*% rotation
}

paths_height <- function(rows) {
  panes <- unique(rows$condition)
  max(1, 0.4 + 2.3 * ceiling(length(panes) / columns_of(panes)))
}

# The way of the held part in every trial, in the frame of the part that the task is about: distance from its axis over
# height. Where there is no such part, in the scene's.
plot_paths <- function(rows) {
  if (nrow(rows) == 0) return(invisible())
  conditions <- sort(unique(rows$condition))
  targets <- targets_of(rows$protocol_sha256[1])
  points <- do.call(rbind, lapply(conditions, function(condition) {
    its <- rows[rows$condition == condition, ]
    p <- as.matrix(its[c("proxy_x_m", "proxy_y_m", "proxy_z_m")])
    if (!is.null(targets[[condition]])) p <- in_frame_of(p, targets[[condition]])
    data.frame(condition = condition, trial = its$trial, aside = sqrt(p[, 1]^2 + p[, 2]^2), up = p[, 3])
  }))
  columns <- columns_of(conditions)
  old <- panels(ceiling(length(conditions) / columns), columns, c(3.4, 4.6, 1.8, 0.6))
  on.exit(par(old))
  for (condition in conditions) {
    its <- points[points$condition == condition, ]
    plot(NA, xlim = c(0, max(points$aside)), ylim = range(points$up), xlab = "", ylab = "", asp = 1)
    abline(h = 0, col = "#b35900", lty = 3)
    for (trial in split(its, its$trial)) lines(trial$aside, trial$up, col = "#1f5a8540", lwd = 0.8)
    unit <- unit_of("courses.csv.gz", "proxy_z_m")
    title(xlab = paste0("distance from the axis [", unit, "]"), line = 2)
    title(ylab = paste0("height [", unit, "]"), line = 3.5)
    pane_title(condition)
  }
  para(if (length(Filter(Negate(is.null), targets[conditions])) > 0)
    "Each line is a trial, in the frame of the part that the task is about, such as a hole: below the dotted line is inside." else
    "Each line is a trial, in the frame of the scene.", class = "note")
}

# ---- What accuracy cost ----------------------------------------------------------------------------------------------

# Error over time of every setting that was measured for accuracy = "auto"; full: those that were picked.
plot_accuracy <- function(accuracy) {
  if (nrow(accuracy) == 0) return(invisible())
  old <- panels(1, 1, c(4.2, 4.8, 0.6, 0.6))
  on.exit(par(old))
  picked <- !is.na(accuracy$picked_for_us) & accuracy$picked_for_us != ""
  plot(accuracy$time_p99_us, pmax(accuracy$error_p99_um, 1e-3), log = "xy", pch = ifelse(picked, 16, 1),
       col = ifelse(picked, "#b35900", "#1f5a85"), cex = ifelse(picked, 1.5, 1),
       xlab = label_of("accuracy.csv", "time_p99_us"), ylab = "")
  title(ylab = label_of("accuracy.csv", "error_p99_um"), line = 3.6)
  text(accuracy$time_p99_us, pmax(accuracy$error_p99_um, 1e-3),
       paste0(accuracy$mode, ", ", accuracy$tolerance_um, " \u00b5m"), pos = 4, cex = 0.65, col = "#444444", xpd = NA)
  para("Each point is a setting of contact that was measured; full: what was picked and used.", class = "note")
}

# ---- Sessions and persons --------------------------------------------------------------------------------------------

outcome_colours <- c(success = "#1f5a85", failure = "#b35900", timeout = "#e0a458", aborted = "#999999",
                     crashed = "#000000", running = "#dddddd")

timeline_height <- function(attempts) 1.1 + 0.16 * min(60, length(unique(paste(attempts$participant_id,
                                                                                 attempts$session))))

# Each session a line of its attempts, in session time.
plot_timeline <- function(attempts) {
  if (nrow(attempts) == 0) return(invisible())
  session <- paste0(attempts$participant_id,
                    if (length(unique(attempts$session)) > 1) paste0(" (", attempts$session, ")"))
  sessions <- sort(unique(session))
  old <- panels(1, 1, c(3.4, 5.2, 1.6, 0.6))
  on.exit(par(old))
  end <- (attempts$start_s + ifelse(is.na(attempts$duration_s), 0, attempts$duration_s)) / 60
  plot(NA, xlim = c(0, max(end)), ylim = c(length(sessions) + 0.5, 0.5), yaxt = "n", xlab = "session time [min]",
       ylab = "")
  axis(2, seq_along(sessions), sessions, tick = FALSE, cex.axis = 0.75, gap.axis = 0.1)
  y <- match(session, sessions)
  rect(attempts$start_s / 60, y - 0.36, end, y + 0.36, border = "#ffffff", lwd = 0.3,
       col = ifelse(attempts$valid == 1, outcome_colours[attempts$outcome], NA))
  invalid <- attempts$valid == 0
  if (any(invalid)) rect((attempts$start_s / 60)[invalid], y[invalid] - 0.36, end[invalid], y[invalid] + 0.36, density = 25,
       col = outcome_colours[attempts$outcome[invalid]])
  shown <- intersect(names(outcome_colours), attempts$outcome)
  legend(par("usr")[2], par("usr")[4], c(shown, if (any(invalid)) "not valid"), bty = "n", horiz = TRUE, cex = 0.8,
         xpd = NA, xjust = 1, yjust = 0.2, fill = c(outcome_colours[shown], if (any(invalid)) NA), border = "#999999",
         density = c(rep(NA, length(shown)), if (any(invalid)) 25))
}

matrix_height <- function(cells) 1.5 + 0.17 * min(60, length(unique(cells$participant_id))) + 0.06 *
  max(nchar(cells$condition), 0)

# Who has which value in which condition of a block: darker is more, crossed is none.
plot_matrix <- function(cells, value) {
  if (all(is.na(cells[[value]]))) return(invisible())
  people <- sort(unique(cells$participant_id))
  conditions <- unique(cells$condition)
  x <- tapply(cells[[value]], list(factor(cells$participant_id, people), factor(cells$condition, conditions)), mean,
              na.rm = TRUE)
  old <- panels(1, 1, c(1 + 0.42 * max(nchar(conditions)), 4.6, 1.2, 5.6))
  on.exit(par(old))
  plot(NA, xlim = c(0.5, length(conditions) + 0.5), ylim = c(length(people) + 0.5, 0.5), xaxt = "n", yaxt = "n",
       xlab = "", ylab = "", xaxs = "i", yaxs = "i", bty = "n")
  axis(1, seq_along(conditions), conditions, tick = FALSE, las = 2, cex.axis = 0.75, gap.axis = 0)
  axis(2, seq_along(people), people, tick = FALSE, cex.axis = 0.75, gap.axis = 0.1)
  range <- range(x[is.finite(x)], 0)
  shade <- function(v) grDevices::colorRampPalette(c("#eef3f7", "#1f5a85"))(64)[
    1 + round(63 * (v - range[1]) / max(diff(range), 1e-300))]
  for (i in seq_along(people)) for (k in seq_along(conditions)) {
    v <- x[i, k]
    rect(k - 0.48, i - 0.46, k + 0.48, i + 0.46, border = NA, col = if (is.finite(v)) shade(v) else "#ffffff")
    if (!is.finite(v)) segments(k - 0.48, i - 0.46, k + 0.48, i + 0.46, col = "#b35900")
  }
  steps <- pretty(range, 4)
  steps <- steps[steps >= range[1] & steps <= range[2]]
  legend(par("usr")[2], par("usr")[4], format(steps), fill = shade(steps), border = NA, bty = "n", xpd = NA, cex = 0.8)
  para("Darker is more; crossed out: no value. ", name(label_of("cells_long.csv", value)), ".", class = "note")
}

# ---- Forms -----------------------------------------------------------------------------------------------------------

profiles_height <- function(scores) max(1, 2.9 * length(unique(scores$questionnaire)))

# A questionnaire's scales: the mean of persons with its interval, a line for each condition.
plot_profiles <- function(scores) {
  scores <- scores[scores$counted == 1 & !is.na(scores$score), ]
  if (nrow(scores) == 0) return(invisible())
  questionnaires <- unique(scores$questionnaire)
  old <- panels(length(questionnaires), 1, c(3.2, 4.2, 1.9, 13))
  on.exit(par(old))
  for (questionnaire in questionnaires) {
    its <- scores[scores$questionnaire == questionnaire, ]
    about <- ifelse(is.na(its$condition), ifelse(is.na(its$block), its$moment, its$block), its$condition)
    groups <- unique(about)
    scales <- unique(its$scale)
    colours <- grDevices::hcl.colors(max(2, length(groups)), "Dark 3")
    plot(NA, xlim = c(0.7, length(scales) + 0.3), ylim = range(its$score) + c(-1e-9, 1e-9), xaxt = "n", xlab = "",
         ylab = "score")
    axis(1, seq_along(scales), scales, tick = FALSE, cex.axis = 0.85, gap.axis = 0.1)
    grid(NA, NULL, col = "#e4e4e4", lty = 1)
    pane_title(questionnaire)
    for (g in seq_along(groups)) {
      beside <- 0.3 * ((g - 0.5) / length(groups) - 0.5)
      mine <- its[about == groups[g], ]
      of <- lapply(scales, function(scale) tapply(mine$score[mine$scale == scale],
                                                  mine$participant_id[mine$scale == scale], mean))
      middle <- vapply(of, mean, 0)
      half <- vapply(of, function(y) if (length(y) > 1) qt(0.975, length(y) - 1) * sd(y) / sqrt(length(y)) else 0, 0)
      at <- seq_along(scales) + beside
      segments(at, middle - half, at, middle + half, col = colours[g])
      lines(at, middle, type = "o", pch = 16, cex = 0.7, col = colours[g])
    }
    legend(par("usr")[2], par("usr")[4], groups, col = colours, pch = 16, lty = 1, bty = "n", xpd = NA, cex = 0.72,
           pt.cex = 0.7)
  }
  para("Means of participants with their ", percent, " intervals.", class = "note")
}
