# Rooms that the tick runs stay in many pieces, so that an edit there is tested soon; with PASSUNG_TICK_ONE_PIECE, as the
# preset `program` has it for who only runs it, they do not.
set(PASSUNG_TICK_ROOMS "^core/(field|shell|contact|motion|closed_form|surface|tick|query|loop)$")
