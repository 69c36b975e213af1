#include "study/protocol/contact_edit.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_folder.h"

namespace passung::protocol {
namespace {

using Outcome = ContactEdit::Outcome;

constexpr const char* kPath = "study.toml";

ContactEdit edit(const std::string& text, const std::vector<ContactKey>& keys) {
    return editContact(text, kPath, keys);
}

TEST(ContactEdit, OnlyValuesOfTheTableChange) {
    // Truth: closed form: the text as a person would write it. Letters of two bytes stand before values, ends of lines
    // are those of the file.
    const std::string before =
        "# [scene.contact] method = \"penalty\"\r\n[scene]\r\nunit = \"mm\"   # größer\r\n\r\n"
        "  [ scene . contact ]  # hier\r\n  \"method\" = 'penalty' # für alle\r\n\tcell_mm=0.5# größer\r\n\r\n"
        "[other]\r\nmethod = \"penalty\"\r\n";
    std::string after = before;
    after.replace(after.find("'penalty'"), 9, "\"god_object\"");
    after.replace(after.find("cell_mm=0.5"), 11, "tolerance_um = 20");
    after.insert(after.find("# größer\r\n\r\n[other]") + 10, "\r\n\tmode = \"cubic\"");
    const auto result = edit(before, {{"method", "\"god_object\""},
                                      {"cell_mm", ""},
                                      {"tolerance_um", "20"},
                                      {"mode", "\"cubic\""},
                                      {"spacing_mm", ""}});
    ASSERT_EQ(result.outcome, Outcome::Changed) << toString(result.error);
    EXPECT_EQ(result.text, after);
    const auto again = edit(after, {{"method", "\"god_object\""}, {"tolerance_um", "20"}});
    EXPECT_EQ(again.outcome, Outcome::Unchanged);
    EXPECT_EQ(again.text, after);
}

TEST(ContactEdit, WritesIntoEveryWayInWhichATableCanBeWritten) {
    // Truth: closed form, as above.
    struct Case {
        std::string before, after;
    };
    const std::vector<ContactKey> keys{{"method", "\"penalty\""}, {"spacing_mm", "2"}};
    for (const Case& c : std::vector<Case>{
             {"[scene]\nunit = \"mm\"",
              "[scene]\nunit = \"mm\"\n\n[scene.contact]\nmethod = \"penalty\"\nspacing_mm = 2\n"},
             {"[scene.contact]\n[x]\n", "[scene.contact]\nmethod = \"penalty\"\nspacing_mm = 2\n[x]\n"},
             {"[scene]\ncontact.mode = \"cubic\"# c",
              "[scene]\ncontact.mode = \"cubic\"# c\ncontact.method = \"penalty\"\ncontact.spacing_mm = 2"},
             {"[scene]\ncontact = { mode = \"cubic\", spacing_mm = 1 } # c\n",
              "[scene]\ncontact = { mode = \"cubic\", spacing_mm = 2, method = \"penalty\" } # c\n"},
             {"scene = { contact = { } }\n", "scene = { contact = { method = \"penalty\", spacing_mm = 2 } }\n"},
             {"scene.contact.spacing_mm = 1.0\n",
              "scene.contact.spacing_mm = 2\nscene.contact.method = \"penalty\"\n"}}) {
        const auto result = edit(c.before, keys);
        ASSERT_EQ(result.outcome, Outcome::Changed) << c.before << toString(result.error);
        EXPECT_EQ(result.text, c.after);
    }
}

TEST(ContactEdit, AKeyGoesWithoutItsComment) {
    // Truth: closed form, as above.
    const auto gone = [](const std::string& text) { return edit(text, {{"cell_mm", ""}}).text; };
    EXPECT_EQ(gone("[scene.contact]\ncell_mm = 1\nmode = \"cubic\"\n"), "[scene.contact]\nmode = \"cubic\"\n");
    EXPECT_EQ(gone("[scene.contact]\ncell_mm = 1 # so\nmode = \"cubic\"\n"),
              "[scene.contact]\n# so\nmode = \"cubic\"\n");
    EXPECT_EQ(gone("[scene.contact]\nmode = \"cubic\"\ncell_mm = 1"), "[scene.contact]\nmode = \"cubic\"\n");
    EXPECT_EQ(gone("[scene]\ncontact = { cell_mm = 1, mode = \"cubic\" }\n"),
              "[scene]\ncontact = { mode = \"cubic\" }\n");
    EXPECT_EQ(gone("[scene]\ncontact = { mode = \"cubic\", cell_mm = 1 }\n"),
              "[scene]\ncontact = { mode = \"cubic\" }\n");
}

TEST(ContactEdit, SaysWhatSetsAKeyElsewhere) {
    // Truth: closed form: the places that the keys were written to.
    const std::string study =
        "[scene.contact]\nmode = \"cubic\"\n[[factor]]\nname = \"how\"\nkey = \"contact.method\"\nlevels = "
        "[\"penalty\"]\n"
        "[[factor]]\nname = \"fine\"\nlevels = [{ label = \"a\", set = { \"contact.spacing_mm\" = 1 } }]\n"
        "[[block]]\nname = \"b\"\nset = { \"contact.two_way\" = true }\n"
        "[[staircase]]\nname = \"s\"\nkey = \"contact.tolerance_um\"\n";
    struct Case {
        const char *key, *value, *place;
    };
    for (const Case& c :
         {Case{"method", "\"penalty\"", "study.toml:5:7: error: contact.method: is set by factor how"},
          {"spacing_mm", "2", "study.toml:9:34: error: contact.spacing_mm: is set by factor fine"},
          {"two_way", "false", "study.toml:12:9: error: contact.two_way: is set by block b"},
          {"tolerance_um", "9", "study.toml:15:7: error: contact.tolerance_um: is set by staircase s"}}) {
        const auto result = edit(study, {{c.key, c.value}});
        EXPECT_EQ(result.outcome, Outcome::SetElsewhere);
        EXPECT_EQ(toString(result.error), c.place);
        EXPECT_EQ(edit(study, {{c.key, c.value, true}}).outcome, Outcome::Unchanged) << "it need not be written";
    }
    EXPECT_EQ(edit(study, {{"mode", "\"linear\""}}).outcome, Outcome::Changed);
}

TEST(ContactEdit, AnIncludedTableIsNotTouchedAndOneBesideIncludedLinesIs) {
    // Truth: closed form, as above.
    const test::TempFolder folder;
    std::ofstream(folder / "base.toml") << "[scene]\nunit = \"mm\"\n# more\n";
    std::ofstream(folder / "contact.toml") << "[scene.contact]\nmode = \"cubic\"\n";
    const std::string path = folder / "study.toml";
    const std::vector<ContactKey> keys{{"mode", "\"linear\""}};
    const auto beside = editContact("include = \"base.toml\"\n[scene.contact]\nmode = \"cubic\" # x\n", path, keys);
    ASSERT_EQ(beside.outcome, Outcome::Changed) << toString(beside.error);
    EXPECT_EQ(beside.text, "include = \"base.toml\"\n[scene.contact]\nmode = \"linear\" # x\n");
    const auto within = editContact("include = \"base.toml\"\ninclude = \"contact.toml\"\n", path, keys);
    EXPECT_EQ(within.outcome, Outcome::Refused);
    EXPECT_EQ(within.error.file, folder / "contact.toml");
    EXPECT_EQ(edit("[scene.contact\n", keys).outcome, Outcome::Refused);
}

}  // namespace
}  // namespace passung::protocol
