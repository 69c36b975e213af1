#include <QtGui/QClipboard>
#include <QtQml/QQmlEngine>
#include <fstream>
#include <set>
#include <tuple>

#include "analysis/export/export.h"
#include "core/scene/scene.h"
#include "core/tick/tick_model.h"
#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"
#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "tests/support/every_effect.h"
#include "tests/ui/cli/small_study.h"
#include "tests/ui/window/windows.h"
#include "ui/presenter/participant_access.h"
#include "ui/window/participants_words.h"
#include "ui/window/study_words.h"

namespace passung {
namespace {

using test::heldPart;
using test::pixelsLike;

/// The experimenter's pages, about a small study of its own.
class Pages : public test::Windows {
protected:
    Pages() {
        std::filesystem::create_directories(folder_ / "protocols/small");
        protocols_ = folder_ / "protocols";
        write(test::smallStudy() + kConsent);
    }

    void write(const std::string& study) const { std::ofstream(protocols_ + "/small/study.toml") << study; }

    void SetUp() override {
        Windows::SetUp();
        activate(app_->experimenter());
    }

    static constexpr const char* kConsent = R"(
[[consent]]
clause = "taking_part"
text.en = "You take part."
text.de = "Sie nehmen teil."
)";

    std::string database() const { return presenter::studyDatabase(data_, "small"); }

    store::StoreReader reader() const {
        auto opened = store::StoreReader::open(database());
        if (!opened) throw std::runtime_error(toString(opened.errors().front()));
        return *std::move(opened);
    }

    /// Whole simulated sessions in the study's own database.
    void perform(int participants) {
        std::filesystem::create_directories(std::filesystem::path(database()).parent_path());
        const auto plan =
            protocol::readProtocol(protocols_ + "/small/study.toml", run::knownDevices(), run::knownMeasures());
        ASSERT_TRUE(plan) << toString(plan.errors().front());
        run::RunOptions options;
        options.database = database();
        options.simulated = participants;
        options.backup = false;
        const auto end = run::runStudy(*plan, options, {});
        ASSERT_TRUE(end) << toString(end.errors().front());
    }

    /// Somebody is enrolled, consents, and their session waits for its start.
    void beginSession() {
        pressKey(Qt::Key_2, Qt::ControlModifier);
        settle();
        type("experimenter", "AB");
        click("enrol");
        settle();
        click("consent-0-yes");
        settle();
        click("startSession");
        waitFor<presenter::state::Ready>();
    }
    void breakOff() {
        activate(app_->experimenter());
        pressKey(Qt::Key_Escape);  // a running trial would be finished first
        waitFor<presenter::state::Stopped>();
        click("abort");
        click("abort");  // really
        waitFor<presenter::state::Incomplete>();
    }

    std::string textOf(const char* name) const {
        const QQuickItem* found = item(app_->experimenter(), name);
        return found != nullptr ? found->property("text").toString().toStdString() : "(not shown)";
    }
    bool enabled(const char* name) const {
        const QQuickItem* found = item(app_->experimenter(), name);
        return found != nullptr && found->isEnabled();
    }
    /// The page of data, of two simulated participants.
    void seeRecords() {
        perform(2);
        click("page-data");
        app_->records().refresh();
        settle();
    }
    QImage shot(const char* name) { return picture(app_->experimenter(), name); }
};

TEST_F(Pages, SomebodyIsEnrolledOnceConsentsIsExcludedReadmittedAndErased) {
    // Truth: invariant. What the page says is what the database holds.
    pressKey(Qt::Key_2, Qt::ControlModifier);
    settle();
    EXPECT_EQ(textOf("nobody"), "Nobody is enrolled yet.");
    EXPECT_EQ(textOf("code"), "P001");
    type("experimenter", "AB");
    click("enrol");
    settle();
    EXPECT_EQ(textOf("code"), "P002") << "the next code";
    EXPECT_EQ(textOf("personCode"), "P001");
    type("code", "P001");
    EXPECT_FALSE(enabled("enrol"));
    EXPECT_EQ(textOf("whyNotEnrol"), "This code is enrolled already.");
    type("code", "P002");
    EXPECT_EQ(textOf("whyNotEnrol"), "");
    pressKey(Qt::Key_Return);
    settle();
    auto people = reader().participants();
    ASSERT_TRUE(people);
    ASSERT_EQ(people->size(), 2u);
    EXPECT_EQ((*people)[1].kind, "real");

    click("person-P001");
    click("consent-0-yes");
    settle();
    const auto consents = reader().consents();
    ASSERT_TRUE(consents && consents->size() == 1);
    EXPECT_EQ(consents->front().decision, "yes");
    shot("participants");

    click("leave");
    click("scope3");
    EXPECT_FALSE(enabled("leavingNext")) << "without a reason";
    type("leavingReason", "was late");
    click("leavingNext");
    shot("participants_exclude");
    click("leavingConfirm");
    settle();
    people = reader().participants();
    EXPECT_EQ(people->front().status, "excluded");
    EXPECT_EQ(people->front().status_reason, "was late");
    EXPECT_FALSE(enabled("startSession"));
    EXPECT_FALSE(enabled("readmit"));
    type("readmitReason", "was not");
    click("readmit");
    settle();
    EXPECT_NE(reader().participants()->front().status, "excluded");

    click("language");
    click("leave");
    click("scope2");
    click("leavingNext");
    type("typedCode", "P002");
    EXPECT_FALSE(enabled("leavingConfirm")) << "the wrong code";
    type("typedCode", "P001");
    click("theme");
    shot("participants_erase_de_light");
    click("leavingConfirm");
    settle();
    people = reader().participants();
    ASSERT_EQ(people->size(), 1u);
    EXPECT_EQ(people->front().participant_id, "P002");
    const auto audit = reader().audit();
    EXPECT_TRUE(audit && audit->faults.empty());
    EXPECT_EQ(textOf("personCode"), "(not shown)");
    shot("participants_de_light");
}

TEST_F(Pages, ASessionIsBegunBrokenOffAndGoneOnWith) {
    // Truth: invariant. What the page begins is what the database holds.
    beginSession();
    EXPECT_NE(item(app_->experimenter(), "stateLine"), nullptr) << "the page of the session is shown";
    click("start");
    waitFor([&] { return run().view().may(session::CommandKind::Pause); });
    breakOff();
    EXPECT_FALSE(app_->records().attempts().isEmpty()) << "the page of data follows by itself";
    click("page-participants");
    settle();
    EXPECT_TRUE(enabled("resume"));
    shot("participants_broken_off");
    const auto first = reader().sessions();
    ASSERT_TRUE(first && first->size() == 1);
    EXPECT_EQ((*first)[0].participant_id, "P001");
    EXPECT_EQ((*first)[0].kind, "real");
    EXPECT_EQ((*first)[0].experimenter, "AB");
    click("resume");
    waitFor<presenter::state::Ready>();
    const auto second = reader().sessions();
    ASSERT_TRUE(second && second->size() == 1) << "it is the same session";
    EXPECT_EQ((*second)[0].segments, 2);

    // Truth: invariant: whoever closes the window while a session runs is asked, and the session goes on meanwhile.
    EXPECT_FALSE(app_->experimenter()->close());
    waitFor([&] { return item(app_->experimenter(), "question") != nullptr; });
    shot("closing");
    click("questionNo");
    EXPECT_EQ(item(app_->experimenter(), "question"), nullptr);
    EXPECT_TRUE(app_->experimenter()->isVisible());
    EXPECT_TRUE(run().view().is<presenter::state::Ready>());
    bool quits = false;
    QObject::connect(qmlEngine(app_->experimenter()), &QQmlEngine::quit, app_->experimenter(), [&] { quits = true; });
    EXPECT_FALSE(app_->experimenter()->close());
    click("questionYes");
    EXPECT_TRUE(quits);
    open("en", true);  // closed, not cut off
    settle();
    EXPECT_EQ(item(app_->experimenter(), "question"), nullptr);
}

TEST_F(Pages, ASessionThatGoesOnIsDrawnAsItBegan) {
    // Truth: invariant: the quality is sought once a session, and is what the first part stored.
    quality_.reset();
    open("en", true);
    activate(app_->experimenter());
    beginSession();
    click("start");
    waitFor([&] { return run().view().quality.has_value(); });
    ASSERT_TRUE(run().view().quality);
    const presenter::QualityFound found = *run().view().quality;
    waitFor([&] { return run().view().may(session::CommandKind::Pause); });
    breakOff();
    click("page-participants");
    settle();
    click("resume");
    waitFor<presenter::state::Ready>();
    click("start");
    waitFor([&] { return run().view().may(session::CommandKind::Pause); });
    ASSERT_TRUE(run().view().quality);
    EXPECT_EQ(run().view().quality->quality, found.quality);
    const QQuickItem* scene = nullptr;
    waitFor([&] { return (scene = item(app_->participant(), "scene")) != nullptr; });
    ASSERT_TRUE(scene) << "the participant's window shows no scene";
    EXPECT_EQ(scene->property("samples").toInt(), found.quality.samples);
    EXPECT_EQ(store::Database(database(), store::OpenMode::ReadOnly)
                  .integer("SELECT count(*) FROM event WHERE event='picture_quality' AND source='window'"),
              1);
}

std::string bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The checksums of an export's files.
std::string sumsOf(const std::string& folder) { return bytesOf(folder + "/SHA256SUMS"); }

TEST_F(Pages, RecordedSessionsAreLookedAtAndExported) {
    // Truth: invariant: the page writes the bytes that an export of the same data has.
    seeRecords();
    EXPECT_EQ(textOf("noData"), "(not shown)");
    const QImage look = shot("data");
    EXPECT_GT(pixelsLike(look.copy(410, 150, 860, 400), app_->look().accent(), 60), 200) << "no strips are drawn";
    type("exportFolder", (folder_ / "out").c_str());
    click("export");
    waitFor([&] { return !app_->records().exporting(); });
    EXPECT_FALSE(app_->records().failed()) << app_->records().told().toStdString();
    ASSERT_TRUE(exporter::exportAll(reader(), folder_ / "other"));
    EXPECT_EQ(sumsOf(folder_ / "out"), sumsOf(folder_ / "other"));
    EXPECT_NE(sumsOf(folder_ / "out"), "");
    click("language");
    click("theme");
    shot("data_de_light");
}

TEST_F(Pages, AReportIsWrittenWithTheExport) {
    // Truth: invariant: beside the page there are the tables of an export of the same data; without R's packages the
    // line that installs them.
    seeRecords();
    EXPECT_EQ(textOf("openReport"), "(not shown)");
    type("exportFolder", (folder_ / "out").c_str());
    click("report");
    waitFor([&] { return !app_->records().exporting(); });
    EXPECT_FALSE(app_->records().failed()) << app_->records().told().toStdString();
    ASSERT_TRUE(exporter::exportAll(reader(), folder_ / "other"));
    for (const std::string table : {"trials.csv", "cells_long.csv"})
        EXPECT_EQ(bytesOf(folder_ / "out" + ("/" + table)), bytesOf(folder_ / "other" + ("/" + table))) << table;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out/analysis.Rmd"));
    const bool has_page = std::filesystem::exists(folder_ / "out/report.html");
    EXPECT_EQ(app_->records().lastReport().isEmpty(), !has_page);
    if (has_page)
        EXPECT_EQ(textOf("openReport"), "Open the report");
    else
        EXPECT_NE(app_->records().told().indexOf("apt"), -1) << app_->records().told().toStdString();
    shot("data_report");
    click("export");
    waitFor([&] { return !app_->records().exporting(); });
    EXPECT_EQ(textOf("openReport"), "(not shown)") << "the folder has no report any more";
}

TEST_F(Pages, WhatIsDamagedIsLeftOutAndSaidAndTheRestIsLookedAtAndExported) {
    // Truth: invariant: one changed value takes its attempt from the page and from the export, nothing else.
    seeRecords();
    const auto whole = app_->records().attempts().size();
    ASSERT_TRUE(exporter::exportAll(reader(), folder_ / "out"));
    store::Database(database(), store::OpenMode::ReadWrite)
        .execute(
            "UPDATE attempt_measure SET value_num=value_num+1 WHERE measure='peak_force_N' AND attempt_id=(SELECT "
            "max(attempt_id) FROM attempt)");
    app_->records().refresh();
    settle();
    EXPECT_EQ(textOf("noData"), "(not shown)");
    EXPECT_TRUE(app_->records().failed());
    EXPECT_EQ(app_->records().told().toStdString(), "Damaged and left out here: 1; passung verify names each");
    EXPECT_EQ(app_->records().attempts().size(), whole - 1);
    shot("data_damaged");
    type("exportFolder", (folder_ / "out").c_str());
    click("export");
    waitFor([&] { return !app_->records().exporting(); });
    EXPECT_TRUE(app_->records().failed());
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out/missing.csv"));
    const std::string told = app_->records().told().toStdString();
    EXPECT_NE(told.find("left out: 1"), std::string::npos);
    EXPECT_NE(told.find("kept as " + (folder_ / "out.backup.1")), std::string::npos) << told;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.backup.1/missing.csv")) << "the earlier one, which was whole";
}

TEST_F(Pages, TryOutsSayWhatTheyLeaveOut) {
    // Truth: closed form: a try-out has neither consent nor instructions nor questionnaires (ui/window/live_session.h).
    click("page-studies");
    settle();
    EXPECT_EQ(textOf("leftOut"), "Both show the trials only: consent, instructions and questionnaires are left out.");
}

TEST(CutOffLine, TellsATrialFromAQuestionnaire) {
    // Truth: closed form
    presenter::SessionEntry session;
    session.planned = 4;
    session.valid = 1;
    EXPECT_TRUE(window::cutOffLine("P001", "today", session).endsWith("was cut off in trial 2 of 4."));
    session.in_form = true;
    EXPECT_TRUE(
        window::cutOffLine("P001", "today", session).endsWith("was cut off in a questionnaire, after 1 of 4 trials."));
}

TEST_F(Pages, AnAttemptIsShownOnceMoreWithItsForceAndItsTime) {
    // Truth: independent program: the ticks as the store's reader has them.
    std::string tight = test::fairStudy();  // so that nobody gets in without touching
    tight.replace(tight.find("bore_diameter = 22"), 18, "bore_diameter = 20.4");
    write(tight);
    app_->studies().reload();
    perform(1);
    click("page-data");
    app_->records().refresh();
    settle();
    // The tick with the strongest force towards the eye, which looks from the front, above: such an arrow is not
    // hidden.
    const QVariantList rows = app_->records().attempts();
    qsizetype which = 0;
    float towards_eye = 0.0f, force = 0.0f;
    std::size_t at = 0;
    for (qsizetype row = 0; row < rows.size(); ++row) {
        const auto ticks = reader().records(rows[row].toMap()["id"].toLongLong());
        ASSERT_TRUE(ticks);
        for (std::size_t i = 0; i < ticks->size(); ++i) {
            const auto& f = (*ticks)[i].force_N;
            if (f[2] - f[1] <= towards_eye) continue;
            towards_eye = f[2] - f[1], force = std::hypot(f[0], f[1], f[2]);
            which = row, at = i;
        }
    }
    ASSERT_GT(towards_eye, 0.2f);
    click(QStringLiteral("attempt-%1").arg(which).toLatin1().constData());
    click("again");
    waitFor([&] { return app_->replay().there() || !app_->replay().told().isEmpty(); });
    ASSERT_EQ(app_->replay().told().toStdString(), "");
    const auto records = reader().records(rows[which].toMap()["id"].toLongLong());
    EXPECT_NEAR(app_->replay().length(), 1e-3 * static_cast<double>(records->size() - 1), 1e-9);
    const QQuickItem* slider = item(app_->experimenter(), "time");
    ASSERT_NE(slider, nullptr);
    click("time");  // the middle
    EXPECT_NEAR(app_->replay().time(), 0.5 * app_->replay().length(), 0.05 * app_->replay().length());
    app_->replay().seek(static_cast<double>(at) * kTickSeconds);
    EXPECT_NEAR(app_->replay().force(), static_cast<double>(force), 1e-6);
    const QQuickItem* scene = item(app_->experimenter(), "replayScene");
    ASSERT_NE(scene, nullptr);
    const QRect area = scene->mapRectToScene(scene->boundingRect()).toRect();
    const QImage contact = shot("replay").copy(area);
    EXPECT_GT(heldPart(contact).x(), 0.0) << "the held part is not drawn";
    const int arrow = pixelsLike(contact, QColor("#d55e00"), 20);
    app_->replay().seek(0.0);
    const int none = pixelsLike(shot("replay_start").copy(area), QColor("#d55e00"), 20);
    EXPECT_GT(arrow, none + 10) << "the force is not drawn";
    click("speed");
    click("play");
    waitFor([&] { return !app_->replay().plays(); });
    EXPECT_EQ(app_->replay().time(), app_->replay().length());
    click("language");
    click("theme");
    shot("replay_de_light");
    click("closeReplay");
    EXPECT_NE(item(app_->experimenter(), "attempts"), nullptr);
}

TEST_F(Pages, AMistakeIsShownAtItsLineUntilItIsRepaired) {
    // Truth: closed form, the line that the mistake was written to.
    const std::string sound = test::smallStudy();
    const std::string file = protocols_ + "/small/study.toml";
    write("passung = 1\n[study]\nname = \"small\"\nversion = 1\n" + sound.substr(sound.find("seed")));
    app_->studies().reload();
    const QVariantList issues = app_->details().issues();
    ASSERT_FALSE(issues.isEmpty());
    EXPECT_EQ(issues[0].toMap()["place"].toString().toStdString(), "study.toml:4:11");
    EXPECT_FALSE(enabled("tryOut"));
    shot("studies_mistake");
    click("issue-0");
    EXPECT_EQ(app_->details().source()["line"].toInt(), 4);
    EXPECT_EQ(QGuiApplication::clipboard()->text().toStdString(), file + ":4");
    EXPECT_GT(pixelsLike(shot("studies_source"), app_->look().bad(), 8), 30) << "the line is not marked";
    write(sound);
    click("reload");
    EXPECT_TRUE(app_->details().issues().isEmpty());
    EXPECT_TRUE(enabled("tryOut"));
}

struct StageText {
    std::string name, reason;
};

/// Of every stage that a scene with everything in it has, with each method.
std::vector<StageText> stageTexts() {
    std::vector<StageText> all;
    scene::PartCache cache;
    using scene::ContactMethod;
    using scene::Geometry;
    using scene::PenaltyCoupling;
    const std::pair<ContactMethod, PenaltyCoupling> methods[] = {
        {ContactMethod::Penalty, PenaltyCoupling::Direct},
        {ContactMethod::Penalty, PenaltyCoupling::QuasiStatic},
        {ContactMethod::Penalty, PenaltyCoupling::Virtual},
        {ContactMethod::GodObjectHeuristic, PenaltyCoupling::Direct},
        {ContactMethod::GodObject, PenaltyCoupling::Direct}};
    for (const auto& [method, coupling] : methods) {
        for (const auto& [two_way, geometry, nodes] : {std::tuple(false, Geometry::Field, 0),
                                                       {true, Geometry::Field, 0},
                                                       {false, Geometry::Field, 100},
                                                       {false, Geometry::Auto, 0}}) {
            scene::SceneSpec spec;
            spec.parts.push_back({.name = "ball",
                                  .geometry = shape::Sphere{0.02},
                                  .X_WP = {Quat::Identity(), Vec3(0.0, 0.0, 0.03)},
                                  .held = true});
            spec.parts.push_back({.name = "table",
                                  .geometry = shape::Box{0.06, 0.06, 0.02},
                                  .X_WP = {Quat::Identity(), Vec3(0.0, 0.0, -0.01)}});
            spec.contact.cell = 2e-3;
            spec.contact.method = method;
            spec.contact.coupling = coupling;
            spec.contact.two_way = two_way;
            spec.contact.geometry = geometry;
            spec.contact.budget_nodes = nodes;
            spec.contact.proxy_filter = 50.0;
            spec.record_hand_depth = true;
            spec.start_gate.hold_ticks = 10;
            spec.limits.delay_ticks = 1;
            test::addEveryEffect(spec);
            spec.display_wrench = false;
            const auto scene = scene::buildScene(spec, cache);
            if (!scene) throw std::runtime_error(toString(scene.errors().front()));
            const tick::TickModel model = tick::makeModel(*scene);
            for (const auto& stage : model.hands.front().stages) all.push_back({stage.name, stage.reason});
        }
    }
    return all;
}

TEST_F(Pages, TheDesignIsExpandedAndStagesAreMeasuredInEitherLanguage) {
    // Truth: independent program: passung explain's orders, here by the numbers that they are made of.
    waitFor([&] { return !app_->details().design().isEmpty(); });
    const QVariantList orders = app_->details().design()["orders"].toList();
    ASSERT_EQ(orders.size(), 4);
    // A Williams square of two: 1 2 and 2 1 in turns, three passes.
    std::set<std::string> rows;
    for (const QVariant& order : orders) {
        const QVariantList passes = order.toMap()["blocks"].toList()[0].toMap()["passes"].toList();
        ASSERT_EQ(passes.size(), 3);
        EXPECT_EQ(passes[0].toMap()["trials"], passes[2].toMap()["trials"]);
        EXPECT_NE(passes[0].toMap()["trials"], passes[1].toMap()["trials"]);
        std::string row;
        for (const QVariant& trial : passes[0].toMap()["trials"].toList())
            row += std::to_string(trial.toMap()["condition"].toInt());
        rows.insert(row);
    }
    EXPECT_EQ(rows, (std::set<std::string>{"12", "21"}));
    app_->experimenter()->requestActivate();
    const auto open = [&](int part) {
        QQuickItem* choice = item(app_->experimenter(), "part");
        QMetaObject::invokeMethod(choice, "picked", Q_ARG(int, part));
    };
    open(1);
    shot("studies_design");
    open(2);
    click("measureStages");
    waitFor([&] { return !app_->details().stages()["measuring"].toBool(); });
    EXPECT_EQ(app_->details().stages()["tables"].toList().size(), 2) << "penalty and god object";
    shot("studies_tick");
    click("language");
    for (const StageText& stage : stageTexts()) {
        EXPECT_NE(window::stageWord(stage.name).toStdString(), stage.name);
        EXPECT_NE(window::stageWord(stage.reason).toStdString(), stage.reason);
    }
    shot("studies_tick_de");
    open(3);
    EXPECT_NE(textOf("accuracyHint"), "");
    click("theme");
    shot("studies_accuracy_de_light");
}

}  // namespace
}  // namespace passung
