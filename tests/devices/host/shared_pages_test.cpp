#include "devices/host/shared_pages.h"

#include <gtest/gtest.h>

#include <thread>

namespace passung::host {
namespace {

TEST(SharedPages, AValueIsReadWholeOrNotAtAll) {
    // Truth: invariant: all numbers of a value are of one writing. Two threads that share a processor with others see
    // few.
    struct Numbers {
        std::uint64_t all[32];
    };
    Seqlocked<Numbers> shared;
    std::atomic<bool> over = false;
    std::thread writer([&] {
        for (std::uint64_t n = 1; !over; ++n) {
            Numbers numbers;
            std::fill(std::begin(numbers.all), std::end(numbers.all), n);
            shared.store(numbers);
        }
    });
    int others = 0;  // than the one before
    bool torn = false, backwards = false;
    std::uint64_t last = 0;
    for (int i = 0; i < 50'000'000 && others < 1000; ++i) {
        const auto numbers = shared.load();
        if (!numbers) continue;
        others += numbers->all[0] != last ? 1 : 0;
        for (const std::uint64_t number : numbers->all) torn = torn || number != numbers->all[0];
        backwards = backwards || numbers->all[0] < last;
        last = numbers->all[0];
    }
    over = true;
    writer.join();
    EXPECT_FALSE(torn);
    EXPECT_FALSE(backwards);
    EXPECT_GT(others, 1);
}

TEST(SharedPages, ATextIsCutToItsPlace) {
    // Truth: invariant: it always ends.
    PlainText<8> text;
    text.put("0123456789");
    EXPECT_EQ(text.view(), "0123456");
    text.put("ab");
    EXPECT_EQ(text.view(), "ab");
    std::fill(std::begin(text.letters), std::end(text.letters), 'x');
    EXPECT_EQ(text.view().size(), 8u) << "even if the other side has spoilt it";
}

TEST(SharedPages, AWriterThatDiedInTheMiddleKeepsNobodyWaiting) {
    // Truth: invariant. The version of a value that is being written is odd: the first word of it.
    Seqlocked<StudyCommand> shared;
    shared.store({});
    ASSERT_TRUE(shared.load());
    reinterpret_cast<std::atomic<std::uint64_t>&>(shared) += 1;
    EXPECT_FALSE(shared.load());
    StudyCommand command;
    command.number = 7;
    shared.store(command);
    ASSERT_TRUE(shared.load());
    EXPECT_EQ(shared.load()->number, 7u);
}

TEST(SharedPages, PagesOfAnotherFormatAreTold) {
    // Truth: invariant.
    PageHead head = PageHead::of<StudyPage>();
    EXPECT_EQ(head, PageHead::of<StudyPage>());
    EXPECT_FALSE(head == PageHead::of<HostPage>());
    head.format += 1;
    EXPECT_FALSE(head == PageHead::of<StudyPage>());
}

}  // namespace
}  // namespace passung::host
