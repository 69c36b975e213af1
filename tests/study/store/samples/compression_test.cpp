#include "study/store/samples/compression.h"

#include <gtest/gtest.h>

#include <string>

namespace passung::store {
namespace {

TEST(Compression, Crc32GivesTheCheckValueOfItsCatalogue) {
    // Truth: closed form (check value of CRC-32/ISO-HDLC over the digits 1 to 9)
    const std::string digits = "123456789";
    EXPECT_EQ(crc32(std::as_bytes(std::span(digits))), 0xcbf43926u);
    EXPECT_EQ(crc32({}), 0u);
}

}  // namespace
}  // namespace passung::store
