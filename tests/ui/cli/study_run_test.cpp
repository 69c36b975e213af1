#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "core/base/digest.h"
#include "core/base/types.h"
#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"
#include "study/store/read/store_reader.h"
#include "study/store/samples/sample_codec.h"
#include "study/store/schema/sqlite.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/support/length.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

namespace passung::test {
namespace {

namespace fs = std::filesystem;

/// Every study that is shipped as an example, relative to `protocols`; rendering_methods_test.cpp and
/// thresholds_test.cpp have those that take longer than a test may.
std::vector<std::string> shippedStudies() {
    const fs::path protocols = fs::path(PASSUNG_SOURCE_DIR) / "protocols";
    std::vector<std::string> studies;
    for (const auto& entry : fs::recursive_directory_iterator(protocols)) {
        const std::string name = fs::relative(entry.path(), protocols).string();
        if (entry.path().extension() != ".toml") continue;
        if (name.starts_with("rendering_methods") || name.starts_with("thresholds")) continue;
        if (readText(entry.path()).find("\n[study]\n") != std::string::npos) studies.push_back(name);
    }
    std::sort(studies.begin(), studies.end());
    return studies;
}

std::string testName(const testing::TestParamInfo<std::string>& info) {
    std::string name = info.param.substr(0, info.param.rfind('.'));
    for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return name;
}

/// An attempt's events of the session, in order of time.
std::vector<store::EventRow> eventsOf(const store::AttemptRow& attempt, const std::vector<store::EventRow>& events) {
    std::vector<store::EventRow> found;
    for (const store::EventRow& event : events) {
        if (event.source == "session" && event.participant_id == attempt.participant_id &&
            event.session_ordinal == attempt.session_ordinal && event.trial_index == attempt.trial_index &&
            event.attempt_no == attempt.attempt_no) {
            found.push_back(event);
        }
    }
    return found;
}

/// The records of an attempt's hands.
using Hands = std::vector<std::vector<TickRecord>>;

Pose proxyOf(const TickRecord& record) {
    const auto& p = record.proxy_position_m;
    const auto& q = record.proxy_quaternion;
    return {Quat(q[0], q[1], q[2], q[3]).normalized(), Vec3(p[0], p[1], p[2])};
}

/// The tip above the target's mouth, along its axis [m].
double heightOverMouth(const plan::Condition& condition, const Hands& hands, std::int64_t tick) {
    const auto i = static_cast<std::size_t>(tick);
    for (const scene::PartSpec& part : condition.scene.parts)
        if (part.name == condition.task.target)
            return ((part.held ? proxyOf(hands.at(part.hand)[i]) : part.X_WP).inverse() * proxyOf(hands[0][i]).p).z();
    throw std::runtime_error("no target");
}

/// The recorded ticks themselves say whether the outcome happened.
void expectOutcomeInRecords(const store::AttemptRow& attempt, std::int64_t start_ns, const Hands& hands,
                            const plan::Condition& condition) {
    const std::int64_t end_tick = (*attempt.end_ns - attempt.start_ns) / kTickNanoseconds;
    const std::int64_t start_tick = (start_ns - attempt.start_ns) / kTickNanoseconds;
    for (const auto& records : hands) ASSERT_LT(static_cast<std::size_t>(end_tick), records.size());
    const auto areEngaged = [&](std::int64_t tick) {
        return std::all_of(hands.begin(), hands.end(), [&](const std::vector<TickRecord>& records) {
            return (records[static_cast<std::size_t>(tick)].status & kEngaged) != 0;
        });
    };
    EXPECT_TRUE(areEngaged(start_tick));
    ASSERT_GT(start_tick, 0) << "the hands hold their start poses first";
    EXPECT_FALSE(areEngaged(start_tick - 1));
    const auto* peg = std::get_if<plan::PegInHoleTask>(&condition.task.form);
    if (peg == nullptr) return;  // trial_types_test.cpp has the other types
    const plan::PegInHoleTask& task = *peg;
    if (attempt.outcome == "success") {
        const auto hold = static_cast<std::int64_t>(std::llround(task.hold / kTickSeconds));
        for (std::int64_t tick = end_tick - hold; tick <= end_tick; ++tick) {
            ASSERT_LE(heightOverMouth(condition, hands, tick), -task.success_fraction * task.insertion_depth + 1e-9);
        }
        EXPECT_LT(end_tick - start_tick, condition.task.timeout / kTickSeconds);
    } else {
        ASSERT_EQ(attempt.outcome, "timeout");
        EXPECT_EQ(end_tick - start_tick, std::llround(condition.task.timeout / kTickSeconds));
    }
}

/// Long studies, which assembly_test.cpp and accuracy_threshold_test.cpp run as well.
bool hasATestOfItsOwn(const std::string& study) {
    return study.starts_with("gearbox_assembly/") || study.starts_with("accuracy_threshold/");
}

/// A shipped study, performed by one simulated person into study.db of a folder of its own.
struct Performed {
    TempFolder folder;
    Ended run;
};

/// Once for all tests of this program.
const Performed& performed(const std::string& study) {
    static std::map<std::string, Performed> all;
    const auto [found, is_new] = all.try_emplace(study);
    if (is_new)
        found->second.run = runProgram(
            found->second.folder.path(),
            {"run", std::string(PASSUNG_SOURCE_DIR) + "/protocols/" + study, "--simulated", "1", "--db", "study.db"});
    return found->second;
}

class ShippedStudy : public testing::TestWithParam<std::string> {};

TEST_P(ShippedStudy, RunsToItsDataFileAndEveryRowSaysWhatHappened) {
    // Truth: invariant (an outcome is what the events, the recorded ticks and the protocol's rules say)
    if (!test::atFullLength() && hasATestOfItsOwn(GetParam())) GTEST_SKIP() << "but for PASSUNG_LONG=1";
    const std::string file = std::string(PASSUNG_SOURCE_DIR) + "/protocols/" + GetParam();
    const auto plan = protocol::readProtocol(file, run::knownDevices(), run::knownMeasures());
    ASSERT_TRUE(plan);
    const auto& [folder, run] = performed(GetParam());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    for (const std::string& line : linesOf(run.err))
        EXPECT_NE(line.find(": warning: feedback.cues = [\"vibrotactile\"]"), std::string::npos) << line;
    const auto reader = store::StoreReader::open(folder / "study.db");
    ASSERT_TRUE(reader);
    const auto sessions = reader->sessions();
    ASSERT_EQ(sessions->size(), static_cast<std::size_t>(plan::sessionsOf(*plan)));
    std::int64_t planned_trials = 0;
    for (const auto& session : *sessions) {
        EXPECT_EQ(session.end_state, "complete");
        EXPECT_EQ(session.epoch, "virtual");
        EXPECT_TRUE(session.device_simulated);
        planned_trials += session.planned_trials;
    }
    const auto attempts = reader->attempts();
    const auto events = reader->events();
    ASSERT_TRUE(attempts && events);
    const auto attempted = static_cast<std::int64_t>(attempts->size());
    EXPECT_TRUE(plan->staircases.empty() ? attempted == planned_trials : attempted <= planned_trials)
        << attempted << " of " << planned_trials << "; a staircase may end early";
    std::map<std::string, int> outcomes;
    for (const store::AttemptRow& attempt : *attempts) {
        SCOPED_TRACE("trial " + std::to_string(attempt.trial_index + 1) + ", " + attempt.condition);
        EXPECT_EQ(attempt.kind, "simulated");
        if (attempt.counts()) {
            EXPECT_NE(run.out.find("\n" + attempt.condition + " "), std::string::npos) << run.out;
        }
        EXPECT_TRUE(attempt.valid) << attempt.invalid_reason.value_or("");
        ++outcomes[attempt.outcome];
        const auto happened = eventsOf(attempt, *events);
        ASSERT_GE(happened.size(), 2u);
        EXPECT_EQ(happened.front().event, "trial_started");
        EXPECT_EQ(happened.back().event, attempt.outcome);
        EXPECT_EQ(happened.back().t_ns, attempt.end_ns);
        EXPECT_EQ(attempt.measures.at("success"), attempt.outcome == "success" ? 1.0 : 0.0);
        const auto seconds = static_cast<double>(*attempt.end_ns - happened.front().t_ns) * 1e-9;
        EXPECT_NEAR(attempt.measures.at("trial_time_s"), seconds, 1e-9);
        const auto condition = std::find_if(plan->conditions.begin(), plan->conditions.end(),
                                            [&](const auto& c) { return c.name == attempt.presented_condition; });
        ASSERT_NE(condition, plan->conditions.end());
        if (condition->timed_by != plan::TimedBy::Program) continue;  // nothing of it is in the ticks
        Hands hands;
        for (std::size_t hand = 0; hand < condition->scene.handCount(); ++hand) {
            auto records = reader->records(attempt.attempt_id, hand);
            ASSERT_TRUE(records);
            hands.push_back(*std::move(records));
        }
        expectOutcomeInRecords(attempt, happened.front().t_ns, hands, *condition);
    }
    for (const auto& [outcome, count] : outcomes)
        std::printf("%s: %d %s\n", GetParam().c_str(), count, outcome.c_str());

    ASSERT_EQ(runProgram(folder.path(), {"export", "study.db", "--out", "tables", "--no-samples"}).exit_code, 0);
    for (const char* table : {"trials.csv", "participants.csv", "sessions.csv"}) {
        const fake::CsvFile csv = fake::readCsv(readText(folder.path() / "tables" / table));
        EXPECT_FALSE(csv.rows.empty());
        for (std::size_t row = 0; row < csv.rows.size(); ++row) EXPECT_EQ(csv.at(row, "kind"), "simulated") << table;
    }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedStudy, testing::ValuesIn(shippedStudies()), testName);

/// Times of the main block's trials of a study's only participant, ascending; a trial that did not succeed counts its
/// time-out.
std::vector<double> trialTimes(const std::string& study) {
    const auto& [folder, run] = performed(study);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const auto reader = store::StoreReader::open(folder / "study.db");
    const auto attempts = reader->attempts();
    std::vector<double> times;
    for (const auto& attempt : *attempts)
        if (attempt.block == "main") times.push_back(attempt.measures.at("trial_time_s"));
    std::sort(times.begin(), times.end());
    return times;
}

TEST(StudyRun, AHoleThatIsNotWhereItIsDrawnCostsTimeOrFails) {
    // Truth: invariant (who knows only what is felt and seen must search). Every tick through the real core, session
    // and store; nothing but the display's place of the hole differs between the two studies, and the names of the
    // streams.
    const auto seen = trialTimes("peg_in_hole/study.toml"), hidden = trialTimes("peg_in_hole/hidden_offset.toml");
    ASSERT_EQ(seen.size(), hidden.size());
    const double ratio = hidden[hidden.size() / 2] / seen[seen.size() / 2];
    std::printf("median trial time: hole where it is drawn %.2f s, 3 mm away %.2f s\n", seen[seen.size() / 2],
                hidden[hidden.size() / 2]);
    EXPECT_GT(ratio, 1.3);
}

/// All files of a folder, by their path in it.
std::map<std::string, std::string> contentOf(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = readText(entry.path());
    }
    return files;
}

std::map<std::string, std::string> exportOf(const std::string& seed) {
    const TempFolder folder;
    writeText(folder / "study.toml", smallStudy());
    const std::string database = "study" + seed + ".db";
    const Ended run =
        runProgram(folder.path(), {"run", "study.toml", "--simulated", "2", "--seed", seed, "--db", database});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(runProgram(folder.path(), {"export", database, "--out", "tables"}).exit_code, 0);
    return contentOf(folder.path() / "tables");
}

TEST(StudyRun, TheSameSeedExportsTheSameBytesAndAnotherSeedOthers) {
    // Truth: invariant (in virtual time nothing but protocol and seed decides)
    const auto first = exportOf("11");
    const auto again = exportOf("11");
    std::size_t samples = 0;
    for (const auto& [path, bytes] : first) {
        ASSERT_TRUE(again.count(path)) << path;
        EXPECT_TRUE(again.at(path) == bytes) << path << " differs";
        samples += path.ends_with(".csv.gz") ? 1 : 0;
    }
    EXPECT_EQ(first.size(), again.size());
    EXPECT_EQ(samples, 12u);
    const auto other = exportOf("12");
    EXPECT_NE(other.at("trials.csv"), first.at("trials.csv"));
}

TEST(StudyRun, ParticipantsOfOneRunEqualThoseOfSeveralRuns) {
    // Truth: invariant (who somebody is and what they do follows from seed and code, not from what ran before)
    const TempFolder folder;
    writeText(folder / "study.toml", smallStudy());
    ASSERT_EQ(runProgram(folder.path(), {"run", "study.toml", "--simulated", "2", "--db", "at_once.db"}).exit_code, 0);
    for (const char* code : {"S001", "S002"}) {
        const Ended run = runProgram(folder.path(), {"run", "study.toml", "--participant", code, "--db", "by_one.db"});
        ASSERT_EQ(run.exit_code, 0) << run.err;
    }
    for (const char* name : {"at_once", "by_one"}) {
        ASSERT_EQ(runProgram(folder.path(), {"export", std::string(name) + ".db", "--out", name}).exit_code, 0);
    }
    EXPECT_TRUE(contentOf(folder.path() / "at_once") == contentOf(folder.path() / "by_one"));
}

/// A small study's database and ways to falsify it.
class Replay : public testing::Test {
protected:
    void SetUp() override {
        writeText(folder_ / "study.toml", smallStudy());
        const Ended run = runProgram(folder_.path(), {"run", "study.toml", "--db", "study.db"});
        ASSERT_EQ(run.exit_code, 0) << run.err;
    }

    /// Flips the lowest bit of one recorded value of attempt 2; with or without a checksum that hides it.
    void falsify(const std::string& column, std::int64_t tick, bool fix_checksum) const {
        const store::Database database(folder_ / "study.db", store::OpenMode::ReadWrite);
        const auto sql =
            "SELECT s.rowid, s.first_tick, s.n, s.data, s.crc32 FROM sample_chunk s WHERE attempt_id=2 AND "
            "first_tick<=? AND first_tick+n>?";
        auto found = database.prepare(sql);
        ASSERT_TRUE(found.bind(tick, tick).step());
        const std::int64_t row = found.integer(0), first = found.integer(1), count = found.integer(2);
        const store::Chunk stored{
            first, count, static_cast<std::uint32_t>(found.integer(4)), {found.blob(3).begin(), found.blob(3).end()}};
        const auto unpacked = store::unpackTicks(stored, store::encodingText());
        ASSERT_TRUE(unpacked) << toString(unpacked.errors().front());
        store::Chunk changed = *unpacked;
        found.reset();
        std::int64_t offset = 0;
        for (const store::Channel& channel : store::tickChannels()) {
            const std::int64_t width = channel.type.ends_with("64") ? 8 : 4;
            if (channel.name == column) {
                changed.data[static_cast<std::size_t>(offset + (tick - first) * width)] ^= std::byte{1};
                const store::Chunk packed = store::packTicks(changed);
                const std::span<const std::byte> bytes(packed.data);
                database.prepare("UPDATE sample_chunk SET data=?, crc32=? WHERE rowid=?")
                    .bind(bytes, fix_checksum ? packed.crc32 : stored.crc32, row)
                    .run();
                return;
            }
            offset += count * width;
        }
        FAIL() << "no column " << column;
    }

    Ended replay(const std::vector<std::string>& options = {}) const {
        std::vector<std::string> arguments = {"replay", "study.db"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return runProgram(folder_.path(), arguments);
    }

    TempFolder folder_;
};

TEST_F(Replay, ReproducesEveryRecordedBit) {
    // Truth: invariant (the tick is a function of the recorded inputs)
    const Ended all = replay();
    EXPECT_EQ(all.exit_code, 0) << all.out << all.err;
    EXPECT_NE(all.out.find("\n6 attempts replayed, 0 differ\n"), std::string::npos) << all.out;
    const Ended one = replay({"--attempt", "3"});
    EXPECT_EQ(one.exit_code, 0);
    EXPECT_EQ(linesOf(one.out).size(), 1u) << one.out;
    EXPECT_NE(one.out.find("attempt 3 (S001, session 1, trial 3, "), std::string::npos) << one.out;
}

TEST_F(Replay, NamesTickAndColumnOfAnOutputThatWasChanged) {
    // Truth: invariant (one bit of one recorded force was flipped, its checksum made to fit)
    falsify("force_y_N", 217, true);
    const Ended changed = replay({"--attempt", "2"});
    EXPECT_EQ(changed.exit_code, 1);
    EXPECT_NE(changed.out.find("DIFFERS at tick 217 in force"), std::string::npos) << changed.out;
    EXPECT_EQ(replay({"--attempt", "1"}).exit_code, 0);
    const Ended all = replay();
    EXPECT_EQ(all.exit_code, 1);
    EXPECT_NE(all.out.find("\n6 attempts replayed, 1 differ\n"), std::string::npos) << all.out;
}

TEST(Navigation, IsRecordedExportedAndReplayedWhereAConditionHasIt) {
    // Truth: invariant. Drift in one of two conditions: a stream of its own with chunks of that one's attempts, a pose
    // that is the registration's and the recorded offset; every bit is replayed, and a changed one found. The same
    // study without it has none of this in file or codebook.
    const TempFolder folder;
    std::string text = smallStudy();
    const std::string fair = "\"contact.method\" = \"god_object_heuristic\"";
    writeText(folder / "without.toml", text);
    writeText(folder / "with.toml",
              text.replace(text.find(fair), fair.size(), fair + ", \"effects.drift.share\" = 0.2"));
    for (const std::string name : {"without", "with"}) {
        const std::string db = name + ".db";
        ASSERT_EQ(runProgram(folder.path(), {"run", name + ".toml", "--db", db}).exit_code, 0);
        ASSERT_EQ(runProgram(folder.path(), {"export", db, "--out", name}).exit_code, 0);
        EXPECT_EQ(runProgram(folder.path(), {"verify", db}).exit_code, 0);
        EXPECT_EQ(runProgram(folder.path(), {"replay", db}).exit_code, 0);
        EXPECT_EQ(readText(folder / name + "/codebook.csv").find("navigation_") != std::string::npos, name == "with");
    }
    const auto require = [](auto result) {
        EXPECT_TRUE(result);
        return *std::move(result);
    };
    const store::StoreReader reader = require(store::StoreReader::open(folder / "with.db"));
    int navigated = 0;
    for (const store::AttemptRow& attempt : require(reader.attempts())) {
        const auto records = require(reader.records(attempt.attempt_id));
        const bool drifts = attempt.condition == "fair";
        EXPECT_EQ(store::haveExtra(store::Extra::Navigation, records), drifts) << attempt.condition;
        if (!drifts) continue;
        ++navigated;
        double moved = 0.0;
        for (const TickRecord& record : records) {
            for (std::size_t i = 0; i < 3; ++i) {
                const double x = record.device_position_m[i] + static_cast<double>(record.navigation_offset_m[i]);
                EXPECT_NEAR(static_cast<double>(record.hand_position_m[i]), x, 1e-8) << record.tick;
            }
            moved = std::max(moved, std::abs(static_cast<double>(record.navigation_offset_m[2])));
        }
        EXPECT_GT(moved, 1e-5);
    }
    EXPECT_GT(navigated, 0);
    {
        const store::Database database(folder / "with.db", store::OpenMode::ReadWrite);
        auto found = database.prepare(
            "SELECT c.rowid, c.first_tick, c.n, c.data, c.crc32 FROM sample_chunk c JOIN stream USING(stream_id) WHERE "
            "stream='navigation' ORDER BY c.rowid");
        ASSERT_TRUE(found.step());
        const std::int64_t row = found.integer(0);
        const store::Chunk stored{found.integer(1),
                                  found.integer(2),
                                  static_cast<std::uint32_t>(found.integer(4)),
                                  {found.blob(3).begin(), found.blob(3).end()}};
        store::Chunk changed = require(store::unpackExtra(store::Extra::Navigation, stored, store::encodingText()));
        changed.data[static_cast<std::size_t>(4 * changed.count + 4 * 300)] ^= std::byte{1};  // the scale of tick 300
        const store::Chunk packed = store::packExtra(store::Extra::Navigation, changed);
        found.reset();
        database.prepare("UPDATE sample_chunk SET data=?, crc32=? WHERE rowid=?")
            .bind(std::span<const std::byte>(packed.data), packed.crc32, row)
            .run();
    }
    const Ended differs = runProgram(folder.path(), {"replay", "with.db"});
    EXPECT_EQ(differs.exit_code, 1);
    EXPECT_NE(differs.out.find("DIFFERS at tick 300 in navigation_scale"), std::string::npos) << differs.out;
    EXPECT_EQ(runProgram(folder.path(), {"verify", "with.db"}).exit_code, 1) << "the hash of the chunk has changed";
}

TEST_F(Replay, FindsTheLastBitOfAChangedInput) {
    // Truth: invariant (the state hash covers exact outputs, also where recorded outputs are rounded)
    falsify("device_z_m", 301, true);
    const Ended changed = replay({"--attempt", "2"});
    EXPECT_EQ(changed.exit_code, 1);
    EXPECT_NE(changed.out.find("DIFFERS"), std::string::npos) << changed.out;
}

TEST_F(Replay, FindsAChangedEnergyOfAnObstacle) {
    // Truth: invariant (bits count).
    {
        const store::Database database(folder_ / "study.db", store::OpenMode::ReadWrite);
        database.execute("UPDATE contact_energy SET taken_in_J=taken_in_J+1e-15 WHERE attempt_id=2 AND place=0");
    }
    const Ended changed = replay({"--attempt", "2"});
    EXPECT_EQ(changed.exit_code, 1);
    EXPECT_NE(changed.out.find("DIFFERS in the energy of"), std::string::npos) << changed.out;
    EXPECT_EQ(replay({"--attempt", "1"}).exit_code, 0);
}

TEST_F(Replay, ProvesNothingWithoutTicksOrWithoutAHash) {
    // Truth: invariant (an attempt that was not compared is not the same)
    {
        const store::Database database(folder_ / "study.db", store::OpenMode::ReadWrite);
        database.execute("UPDATE attempt SET state_hash=NULL WHERE attempt_id=1");
        database.execute("DELETE FROM sample_chunk WHERE attempt_id=2");
        database.execute("UPDATE attempt SET state_hash=NULL WHERE attempt_id=2");
    }
    for (const auto& [attempt, why] : {std::pair{"1", "there is no state hash"}, {"2", "no tick of it is recorded"}}) {
        const Ended ended = replay({"--attempt", attempt});
        EXPECT_EQ(ended.exit_code, 1);
        EXPECT_NE(ended.out.find("NOT PROVEN"), std::string::npos) << ended.out;
        EXPECT_NE(ended.out.find(why), std::string::npos) << ended.out;
    }
    const Ended all = replay();
    EXPECT_EQ(all.exit_code, 1);
    EXPECT_NE(all.out.find("\n6 attempts replayed, 0 differ, 2 could not be proven\n"), std::string::npos) << all.out;
}

/// A closed tetrahedron with edges of some centimetres along the axes, as text STL [mm].
std::string tetrahedron(double edge) {
    const std::string e = std::to_string(edge);
    const std::array<std::string, 4> corners = {"0 0 0", e + " 0 0", "0 " + e + " 0", "0 0 " + e};
    std::string text = "solid t\n";
    for (const auto& [a, b, c] : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const int corner : {a, b, c}) text += "vertex " + corners[static_cast<std::size_t>(corner)] + "\n";
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid t\n";
}

TEST(ReplayOfMeshes, NeedsTheMeshesThatTheTrialsWereMadeWith) {
    // Truth: invariant (another geometry proves nothing; where the file was is not stored)
    const TempFolder folder;
    fs::create_directories(folder.path() / "lab/parts");
    fs::create_directories(folder.path() / "elsewhere");
    std::string study = smallStudy();
    study.insert(study.find("[[scene.part]]"),
                 "[[scene.part]]\nname = \"mark\"\nmesh = \"parts/mark.stl\"\npose = { position = [200, 0, 0] }\n\n");
    writeText(folder / "lab/study.toml", study);
    writeText(folder / "lab/parts/mark.stl", tetrahedron(20));
    ASSERT_EQ(runProgram(folder.path(), {"run", "lab/study.toml", "--db", "study.db"}).exit_code, 0);

    const auto replay = [&](const fs::path& from, std::vector<std::string> options) {
        options.insert(options.begin(), {"replay", folder / "study.db", "--attempt", "1"});
        return runProgram(from, options);
    };
    const Ended here = replay(folder.path() / "lab", {});
    EXPECT_EQ(here.exit_code, 0) << here.out << here.err;
    EXPECT_EQ(replay(folder.path() / "elsewhere", {"--meshes", folder / "lab"}).exit_code, 0);
    const Ended missing = replay(folder.path() / "elsewhere", {});
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_NE(missing.err.find("\"parts/mark.stl\": there is no such file"), std::string::npos) << missing.err;
    EXPECT_NE(missing.err.find("--meshes"), std::string::npos) << missing.err;
    fs::rename(folder.path() / "study.db", folder.path() / "lab/study.db");
    const Ended beside = runProgram(folder.path() / "elsewhere", {"replay", folder / "lab/study.db", "--attempt", "1"});
    EXPECT_EQ(beside.exit_code, 0) << beside.err;

    writeText(folder / "lab/parts/mark.stl", tetrahedron(20.5));
    const Ended changed = runProgram(folder.path() / "lab", {"replay", "study.db"});
    EXPECT_EQ(changed.exit_code, 1);
    EXPECT_NE(changed.err.find("parts/mark.stl: error: SHA-256: "), std::string::npos) << changed.err;
    EXPECT_EQ(linesOf(changed.err).size(), 1u) << changed.err;
    const Ended again = runProgram(folder.path() / "lab", {"run", "study.toml", "--db", "study.db"});
    EXPECT_EQ(again.exit_code, 1) << "one protocol, one geometry";
    EXPECT_NE(again.err.find("parts/mark.stl has changed"), std::string::npos) << again.err;
}

TEST_F(Replay, TellsADamagedChunkAndGoesOnWithTheRest) {
    // Truth: invariant (one bit was flipped, the checksum is the old one)
    falsify("force_y_N", 217, false);
    const std::string damage = "attempt 2: chunk of samples from tick 0: checksum does not match";
    const Ended all = replay();
    EXPECT_NE(all.out.find("\n5 attempts replayed, 0 differ, 1 damaged and not compared\n"), std::string::npos)
        << all.out;
    for (const Ended& told : {replay({"--attempt", "2"}), all}) {
        EXPECT_EQ(told.exit_code, 1);
        EXPECT_NE(told.out.find("DAMAGED: " + damage), std::string::npos) << told.out;
    }
    EXPECT_EQ(replay({"--attempt", "1"}).exit_code, 0);
    const Ended exported = runProgram(folder_.path(), {"export", "study.db", "--out", "tables"});
    EXPECT_EQ(exported.exit_code, 1);
    EXPECT_EQ(linesOf(exported.err).size(), 1u) << exported.err;
    EXPECT_NE(exported.err.find("missing.csv"), std::string::npos) << exported.err;
    EXPECT_TRUE(fs::exists(folder_ / "tables/missing.csv"));
    EXPECT_FALSE(fs::exists(folder_ / "tables.partial"));
}

}  // namespace
}  // namespace passung::test
