#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>

#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

// What the program leaves on a disk for others to read, and what erasing somebody says of it.

namespace passung::test {
namespace {

namespace fs = std::filesystem;

unsigned modeOf(const fs::path& path) {
    struct stat file = {};
    return stat(path.c_str(), &file) == 0 ? file.st_mode & 0777 : 0;
}

class Privacy : public testing::Test {
protected:
    Privacy() : mask_(umask(022)) {
        setenv("XDG_DATA_HOME", (folder_ / "data").c_str(), 1);
        writeText(folder_ / "study.toml", smallStudy());
    }
    ~Privacy() override { umask(mask_); }

    Ended run(const std::vector<std::string>& arguments) const { return runProgram(folder_.path(), arguments); }
    std::string does(const std::vector<std::string>& arguments) const {
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return ended.out;
    }
    bool holds(const std::string& file, const std::string& text) const {
        return readText(folder_ / file).find(text) != std::string::npos;
    }

    mode_t mask_;
    TempFolder folder_;
};

TEST_F(Privacy, DatabaseBackupAndExportAreTheOwnersUnlessTheyAreShared) {
    // Truth: closed form (modes of all files, with the mask that lets everybody read)
    for (const bool group : {false, true}) {
        std::vector<std::string> study = {"run", "study.toml", "--db", "s.db"},
                                 table = {"export", "s.db", "--out", "t"};
        if (group)
            for (auto* arguments : {&study, &table}) arguments->push_back("--group");
        does(study);
        does(table);
        const unsigned file = group ? 0660 : 0600, folder = group ? 0770 : 0700;
        for (const char* name : {"s.db", "s.db.backup", "s.db.backup.sha256", "s.db.log"})
            EXPECT_EQ(modeOf(folder_ / name), file) << name;
        EXPECT_EQ(modeOf(folder_ / "t"), folder);
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / "t"))
            EXPECT_EQ(modeOf(entry.path()), entry.is_directory() ? folder : file) << entry.path();
        EXPECT_EQ(modeOf(folder_ / "data/passung/exports"), 0600u);
        EXPECT_FALSE(fs::exists(folder_ / "s.db-wal"));
    }
}

TEST_F(Privacy, ReadingLeavesTheDatabaseAndItsFolderAsTheyAre) {
    // Truth: closed form (bytes and names before and after)
    const fs::path archive = folder_.path() / "archive";
    fs::create_directory(archive);
    does({"run", "study.toml", "--db", "archive/s.db", "--no-backup"});
    const std::string before = readText(archive / "s.db");
    fs::permissions(archive / "s.db", fs::perms(0400));
    does({"export", "archive/s.db", "--out", "t"});
    does({"replay", "archive/s.db", "--attempt", "1"});
    does({"participant", "list", "archive/s.db"});
    EXPECT_EQ(readText(archive / "s.db"), before);
    EXPECT_EQ(modeOf(archive / "s.db"), 0400u);
    EXPECT_EQ(std::distance(fs::directory_iterator(archive), fs::directory_iterator()), 2) << "the database, its log";
}

TEST_F(Privacy, ErasingTakesTheBackupAlongAndNamesTheExportsThatAreLeft) {
    // Truth: closed form (a search for the code's bytes) and invariant: an export that is gone, and one of another
    // study, are not named.
    does({"participant", "enrol", "s.db", "--protocol", "study.toml"});
    does({"participant", "enrol", "s.db"});
    does({"run", "study.toml", "--db", "s.db"});
    does({"participant", "enrol", "other.db", "--protocol", "study.toml"});
    fs::create_directories(folder_ / "far/away");
    for (const char* out : {"far/away/tables", "far/gone", "beside"}) does({"export", "s.db", "--out", out});
    does({"export", "other.db", "--out", "far/other"});
    fs::remove_all(folder_ / "far/gone");

    const std::string said = does({"participant", "withdraw", "s.db", "P001", "--scope", "erase"});
    EXPECT_FALSE(holds("s.db", "P001"));
    EXPECT_FALSE(holds("s.db.backup", "P001"));
    EXPECT_TRUE(holds("s.db.backup", "P002"));
    EXPECT_NE(said.find("P001: erased from the backup s.db.backup too\n"), std::string::npos) << said;
    for (const auto& [folder, named] : {std::pair("far/away/tables", true), std::pair("beside", true),
                                        std::pair("gone", false), std::pair("far/other", false)})
        EXPECT_EQ(said.find(folder) != std::string::npos, named) << folder << "\n" << said;

    const std::string kept = does({"participant", "withdraw", "s.db", "P002", "--scope", "erase", "--backup", "keep"});
    EXPECT_FALSE(holds("s.db", "P002"));
    EXPECT_TRUE(holds("s.db.backup", "P002"));
    EXPECT_EQ(kept.find("erased from the backup"), std::string::npos) << kept;
    EXPECT_NE(kept.find("of this database: s.db.backup\n"), std::string::npos) << kept;
}

/// A terminal at whose other end `typed` has been typed.
class Keyboard {
public:
    Keyboard(const fs::path& in, const std::string& typed) : end_(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
        if (end_ < 0 || grantpt(end_) != 0 || unlockpt(end_) != 0) throw std::runtime_error("no terminal");
        fs::remove(in);
        fs::create_symlink(ptsname(end_), in);
        other_ = open(ptsname(end_), O_RDWR | O_NOCTTY | O_CLOEXEC);  // what is typed waits for who reads it
        if (write(end_, typed.data(), typed.size()) != static_cast<ssize_t>(typed.size()))
            throw std::runtime_error("cannot type");
    }
    ~Keyboard() {
        close(other_);
        close(end_);
    }
    Keyboard(const Keyboard&) = delete;
    Keyboard& operator=(const Keyboard&) = delete;

private:
    int end_, other_ = -1;
};

TEST_F(Privacy, InATerminalErasingAsksAboutTheBackup) {
    // Truth: invariant, by what the files hold then
    does({"participant", "enrol", "s.db", "--protocol", "study.toml"});
    for (int i = 0; i < 2; ++i) does({"participant", "enrol", "s.db"});
    does({"run", "study.toml", "--db", "s.db"});
    const auto erase = [&](const std::string& code, const std::string& typed) {
        const Keyboard keyboard(folder_.path() / ".in", typed);
        return run({"participant", "withdraw", "s.db", code, "--scope", "erase"});
    };
    EXPECT_NE(erase("P001", "n\n").out.find("from the backup"), std::string::npos);
    EXPECT_TRUE(holds("s.db.backup", "P001"));
    EXPECT_FALSE(holds("s.db", "P001"));
    EXPECT_EQ(erase("P002", "perhaps\n\n").exit_code, 0);
    EXPECT_FALSE(holds("s.db.backup", "P002"));
    EXPECT_EQ(erase("P003", "\x04").err, "s.db: error: nobody answered: nothing was erased\n");
    EXPECT_TRUE(holds("s.db", "P003"));
}

}  // namespace
}  // namespace passung::test
