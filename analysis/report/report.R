# What analysis.Rmd is made with: files and their sums, numbers with an id, tables. Every number of the report passes
# num(), count() or p_value(), which write it into results.json as well.

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

read_sums <- function() read.table("SHA256SUMS", col.names = c("sum", "file"), colClasses = "character", quote = "",
                                  comment.char = "")

# Stops if a table is not what it was when this folder was written.
check_tables <- function() {
  sums <- read_sums()
  for (i in which(!grepl("/", sums$file) & grepl("[.]csv([.]gz)?$", sums$file))) {
    file <- sums$file[i]
    if (!file.exists(file) || digest::digest(file = file, algo = "sha256") != sums$sum[i])
      stop(file, ": is not the file that was written into this folder: its SHA-256 differs from SHA256SUMS",
           call. = FALSE)
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

unit_of <- function(file, column) codebook$unit[codebook$file == file & codebook$column == column]

# ---- Numbers ---------------------------------------------------------------------------------------------------------

report <- new.env()
report$results <- new.env()  # by id, in the order of `ids`
report$shown <- new.env()
report$ids <- character()
report$cells <- list()
report$left_out <- list()
report$not_computed <- list()
report$warnings <- list()

escape <- function(x) gsub("`", "&#96;",
                           gsub("\"", "&quot;", gsub(">", "&gt;", gsub("<", "&lt;", gsub("&", "&amp;", x)))))

# The id of a part: "a1" %.% "p" is a1.p.
`%.%` <- function(id, part) paste0(id, ".", part)

# A word of the study: a level, a code, a column.
name <- function(x) paste0("<span class=\"name\">", escape(x), "</span>")

keep <- function(id, x, text) {
  if (!is.null(report$results[[id]])) stop("two results have the id ", id)
  report$ids[length(report$ids) + 1] <- id
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
    paste0(sub("e[+]?(-?)0*", "&thinsp;&times;&thinsp;10<sup>\\1", formatC(x, digits = digits - 1, format = "e")),
           "</sup>") else
    formatC(x, digits = decimals, format = "f")
  gsub("-", "&minus;", text)
}

# x with its id: with so many significant digits, or so many decimals.
num <- function(id, x, digits = 3, decimals = decimals_of(x, digits)) keep(id, x,
  decimal(unname(x), decimals, digits))

count <- function(id, n) keep(id, n, if (is.na(n)) "&ndash;" else formatC(n, format = "d"))

# Degrees of freedom: whole where they are.
degrees <- function(id, df) if (isTRUE(abs(df - round(df)) < 0.005)) keep(id, df,
  formatC(round(df), format = "d")) else num(id, df)

p_value <- function(id, p) keep(id, p, if (length(p) == 1 && isTRUE(p < 0.001)) "&lt;&thinsp;0.001" else
  if (length(p) == 1 && is.finite(p)) formatC(p, digits = 3, format = "f") else "&ndash;")

shown_p <- function(id, p) {
  p_value(id, p)
  again_p(id)
}

again_p <- function(id) if (isTRUE(report$results[[id]] < 0.001)) again(id) else paste0("= ", again(id))

interval <- function(id, lo, hi, decimals = decimals_of(c(lo, hi), 3))
  paste0("[", num(id %.% "lo", lo, decimals = decimals), ", ", num(id %.% "hi", hi, decimals = decimals), "]")

# An estimate and its interval, both to three digits of the interval's width.
estimate <- function(id, x, lo, hi, name = "estimate") {
  decimals <- decimals_of(if (isTRUE(hi > lo)) hi - lo else x, 3)
  c(num(id %.% name, x, decimals = decimals), interval(id %.% name, lo, hi, decimals))
}

again_interval <- function(id) paste0("[", again(id %.% "lo"), ", ", again(id %.% "hi"), "]")

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
  html("<div class=\"banner\">",
       if (studied == "simulated") "Simulated participants: this shows that study and analysis work, never how people behave"
       else "Pilot data: made to try the study, no result of it",
         "</div>\n<style>h1:not(.title)::after, h2::after { content: \"", studied, "\" }</style>")
}

# ---- Pictures --------------------------------------------------------------------------------------------------------

# So many panels in a plain frame; returns what to give back to par().
panels <- function(rows, columns, margins, below = 0) par(mfrow = c(rows, columns), mar = margins,
  oma = c(below, 0, 0, 0), mgp = c(2.3, 0.5, 0),
  tcl = -0.25, las = 1, bty = "l", cex = 0.8, fg = "#444444", col.axis = "#444444", col.lab = "#444444")

# Above so many panels from here on, as small as it takes.
pane_title <- function(text, panes = 1) title(main = text, font.main = 1, adj = 0, line = 0.5, xpd = NA,
  cex.main = max(0.5, min(1, panes * par("fin")[1] * 0.85 / strwidth(text, "inches", cex = 1))))

columns_of <- function(panes) if (length(panes) %in% c(2, 4)) 2 else min(3, length(panes))

# ---- Programs --------------------------------------------------------------------------------------------------------

show_programs <- function() {
  used <- sort(loadedNamespaces())
  para("Computed by ", name(R.version.string), " with ",
       name(paste(vapply(used, function(package) paste(package, packageVersion(package)), ""), collapse = ", ")), ".",
         class = "note")
}

# ---- results.json ----------------------------------------------------------------------------------------------------

write_results <- function(studied) {
  for (id in names(report$not_computed)) cat("not computed: ", id, ": ", report$not_computed[[id]], "\n", sep = "",
    file = stderr())
  text <- jsonlite::toJSON(list(kind = studied, results = mget(report$ids, report$results), cells = report$cells,
                                left_out = report$left_out,
                                not_computed = report$not_computed, disagreements = report$warnings),
                           auto_unbox = TRUE, digits = I(17), na = "null", null = "null", pretty = TRUE)
  writeLines(text, "results.json", useBytes = TRUE)
}
