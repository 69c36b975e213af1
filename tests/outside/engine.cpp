// Truth: invariant. A study that is performed by another program has every planned trial in its database. Its file:
// the first argument, its database: the second.

#include <cstdio>

#include "study/run/files/protocol_files.h"
#include "study/run/run_study.h"
#include "study/store/read/store_reader.h"

using namespace passung;

int main(int count, char** arguments) {
    if (count != 3) return 2;
    const auto told = [](const Errors& errors) {
        for (const Error& error : errors) std::puts(error.message.c_str());
        return 1;
    };
    const auto plan = run::readProtocol(arguments[1]);
    if (!plan) return told(plan.errors());
    const auto end = run::runStudy(*plan, {.database = arguments[2], .simulated = 1, .backup = false}, {});
    if (!end) return told(end.errors());
    const auto reader = store::StoreReader::open(arguments[2]);
    if (!reader) return told(reader.errors());
    const auto attempts = reader->attempts();
    if (!attempts) return told(attempts.errors());
    std::printf("%zu attempts\n", attempts->size());
    return *end == run::RunEnd::Complete && attempts->size() >= 2 ? 0 : 1;
}
