#include "study/store/rows/event_rows.h"

#include "study/store/schema/named_columns.h"
#include "study/store/schema/view_columns.h"

namespace passung::store {

void insertEvent(const Database& database, std::int64_t segment_id, const session::Event& event,
                 const std::optional<std::string>& utc) {
    std::optional<std::int64_t> attempt_id;
    if (event.attempt) attempt_id = static_cast<std::int64_t>(*event.attempt);
    insertRow(database, "event", Named{"segment_id", segment_id}, Named{"attempt_id", attempt_id},
              Named{"t_ns", event.t_ns}, Named{"source", event.source}, Named{"event", event.event},
              Named{"payload_json", event.payload_json}, Named{"t_utc", utc});
}

void eachEvent(const Database& database, const std::function<void(const EventRow&)>& take) {
    const Selection<EventRow> columns = {{"s.participant_id", &EventRow::participant_id},
                                         {"p.kind", &EventRow::kind},
                                         {"s.ordinal", &EventRow::session_ordinal},
                                         {"e.t_ns", &EventRow::t_ns},
                                         {kEventUtc, &EventRow::t_utc},
                                         {"t.trial_index", &EventRow::trial_index},
                                         {"a.attempt_no", &EventRow::attempt_no},
                                         {"e.source", &EventRow::source},
                                         {"e.event", &EventRow::event},
                                         {"e.payload_json", &EventRow::payload_json}};
    columns.each(database,
                 "FROM event e JOIN segment g USING(segment_id) JOIN session s USING(session_id) "
                 "JOIN participant p USING(participant_id) LEFT JOIN attempt a ON a.attempt_id=e.attempt_id "
                 "LEFT JOIN trial_plan t USING(trial_id) "
                 "ORDER BY s.participant_id, s.ordinal, g.segment_id, e.t_ns, e.event_id",
                 take);
}

}  // namespace passung::store
