# Ticks of a Passung database: ticks("study.db", attempt_id) gives a data frame whose columns are bit for bit those of
# the export's samples. attempt_id: of the database's view v_trials. Needs RSQLite and jsonlite (Debian: r-cran-rsqlite,
# r-cran-jsonlite), and nothing to unpack: the blobs are zlib streams.

query <- function(database, sql, ...) {
  connection <- DBI::dbConnect(RSQLite::SQLite(), database, flags = RSQLite::SQLITE_RO)
  on.exit(DBI::dbDisconnect(connection))
  DBI::dbGetQuery(connection, sql, params = list(...))
}

# Words of 64 bits as two halves, each an exact double: R has no such integers.
whole <- 2^32
unfold <- function(low, high, wide) {  # 0, 1, 2, 3 ... stand for 0, -1, 1, -2 ...
  negative <- low %% 2 == 1
  low <- low %/% 2 + (high %% 2) * 2^31
  high <- high %/% 2
  list(low = ifelse(negative, whole - 1 - low, low), high = ifelse(negative & wide, whole - 1 - high, high))
}

# The n values of a column. order: how often differences were taken; NA: the planes are of the values themselves.
column <- function(planes, n, type, order) {
  wide <- type %in% c("float64", "int64")
  bytes <- matrix(as.numeric(planes), nrow = n)
  half <- function(first) drop(bytes[, first + 0:3, drop = FALSE] %*% 256^(0:3))
  word <- list(low = half(1), high = if (wide) half(5) else rep(0, n))
  if (!is.na(order)) word <- unfold(word$low, word$high, wide)
  for (i in seq_len(if (is.na(order)) 0 else order)) {
    sums <- cumsum(word$low)
    word <- list(low = sums %% whole, high = (cumsum(word$high) + sums %/% whole) %% whole)
  }
  signed <- function(x) x - whole * (x >= 2^31)
  if (type == "uint32") return(word$low)
  if (type == "int32") return(signed(word$low))
  if (type == "int64") return(signed(word$high) * whole + word$low)
  halves <- if (wide) rbind(word$low, word$high) else word$low
  raws <- writeBin(suppressWarnings(as.integer(signed(halves))), raw(), endian = "little")  # NA is -2^31, as it must be
  readBin(raws, "double", n, size = if (wide) 8 else 4, endian = "little")
}

chunk <- function(first, n, blob, encoding, channels) {
  differences <- startsWith(encoding, "columns-v3")  # v2: none were taken
  body <- memDecompress(blob[-(1:4)], "gzip")
  widths <- ifelse(channels$type %in% c("float64", "int64"), 8, 4)
  while (length(body) != n * sum(widths) + differences * length(widths)) widths <- head(widths, -1)  # older programs
  ends <- cumsum(n * widths) + differences * length(widths)
  result <- lapply(seq_along(widths), function(i) {
    column(body[(ends[i] - n * widths[i] + 1):ends[i]], n, channels$type[i],
           if (differences) as.integer(body[i]) else NA)
  })
  cbind(tick = first + seq_len(n) - 1, as.data.frame(setNames(result, head(channels$name, length(widths)))))
}

# stream: "tick", of another hand "tick_hand_2" and so on; "tick_timing", "bodies" ...: see the table stream.
ticks <- function(database, attempt_id, stream = "tick") {
  found <- query(database, "SELECT first_tick, n, data, encoding, channels_json FROM sample_chunk JOIN stream
    USING(stream_id) WHERE attempt_id = ? AND stream = ? ORDER BY first_tick", attempt_id, stream)
  do.call(rbind, lapply(seq_len(nrow(found)), function(i) with(found[i, ], chunk(
    first_tick, n, data[[1]], encoding, jsonlite::fromJSON(channels_json)))))
}
