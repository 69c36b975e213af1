# Rscript report_page.R FOLDER: every number of report.html stands with an id of results.json and shows its value, rounded;
# no other digit stands in the page but in words of the study; nothing was left uncomputed. Exit code 1 if not.
folder <- commandArgs(trailingOnly = TRUE)[1]
read <- function(file) paste(readLines(file.path(folder, file), encoding = "UTF-8", warn = FALSE), collapse = "\n")
page <- read("report.html")
lines <- readLines(file.path(folder, "results.json"))
wrong <- character()

last <- which(grepl("^  \"cells\": ", lines)) - 2
entries <- lines[seq(which(grepl("\"results\": ", lines)) + 1, last)]
results <- setNames(suppressWarnings(as.numeric(sub("^.*\": ([^,]*),?$", "\\1", entries))), sub("^ *\"(.*)\": .*$", "\\1", entries))
if (!any(grepl("\"not_computed\": \\[\\]", lines))) wrong <- c(wrong, lines[seq(which(grepl("not_computed", lines)), length(lines))])

body <- sub("^.*<body[^>]*>", "", page)
body <- gsub("(?s)<(style|script)[^>]*>.*?</(style|script)>", "", body, perl = TRUE)
body <- gsub("<img[^>]*>", "", body)
spans <- regmatches(body, gregexpr("(?s)<span data-result=\"[^\"]*\">.*?</span>", body, perl = TRUE))[[1]]
ids <- sub("^<span data-result=\"([^\"]*)\">.*$", "\\1", spans)
shown <- gsub("<sup>(.*?)</sup>", "e\\1", sub("^<span[^>]*>(.*)</span>$", "\\1", spans))
shown <- gsub("\u2009|&thinsp;|&#8201;", "", gsub("\u2212|&minus;", "-", shown))
shown <- gsub("(\u00d7|&times;)10e", "e", shown)
values <- unname(results)[match(ids, names(results))]
unknown <- !(ids %in% names(results))
none <- shown %in% c("\u2013", "&ndash;")
small <- grepl("^(&lt;|<)0[.]001$", shown)
endless <- grepl("\u221e|&infin;", shown)
number <- suppressWarnings(as.numeric(shown))
decimals <- nchar(sub("^[^.e]*[.]?", "", sub("e.*$", "", shown)))
power <- ifelse(grepl("e", shown), suppressWarnings(as.numeric(sub("^.*e", "", shown))), 0)
right <- ifelse(none, is.na(values), ifelse(small, values < 0.001, endless | abs(number - values) <= 0.5000001 * 10^(power - decimals)))
if (any(unknown)) wrong <- c(wrong, paste(ids[unknown], "is no id of results.json"))
for (i in which(!unknown & !(right %in% TRUE))) wrong <- c(wrong, sprintf("%s shows %s and is %.12g", ids[i], shown[i], values[i]))
never <- setdiff(names(results), ids)
if (length(never) > 0) wrong <- c(wrong, paste("never shown:", never))

rest <- gsub("(?s)<span data-result=\"[^\"]*\">.*?</span>", "", body, perl = TRUE)
rest <- gsub("(?s)<span class=\"name\">.*?</span>", "", rest, perl = TRUE)
rest <- sub("(?s)<h1 class=\"title[^>]*>.*?</h1>", "", rest, perl = TRUE)
text <- gsub("&[#a-zA-Z0-9]+;", "", gsub("<[^>]*>", "", rest))
stray <- regmatches(text, gregexpr(".{0,30}[0-9].{0,30}", text))[[1]]
if (length(stray) > 0) wrong <- c(wrong, paste("a number without an id:", stray))

if (length(wrong) > 0) cat(wrong, sep = "\n")
cat(sprintf("%d numbers with an id, %d faults\n", length(spans), length(wrong)))
if (length(wrong) > 0 || length(spans) == 0) quit(status = 1)
