// Registers of eCAN-A, part of the register map: included by registers.h, which has the conventions.
//
// Control registers have 32 bits and may only be accessed as such. Mailbox memory (masks, time stamps, messages) also
// takes accesses of one word. Source: TI's DSP280x headers; SPRUEU1 for what the bits do.

#ifndef STILLSPIN_HAL_F2808_REGISTERS_CAN_H
#define STILLSPIN_HAL_F2808_REGISTERS_CAN_H

#define ECAN_MAILBOXES 32u

// ---- One bit a mailbox -------------------------------------------------------------------------------
#define REG_CANME 0x6000uL   // mailbox enable (32)
#define REG_CANMD 0x6002uL   // direction, 1 receives (32)
#define REG_CANTRS 0x6004uL  // transmit request, write 1 sets (32)
#define REG_CANTRR 0x6006uL  // takes a transmit request back, write 1 sets (32)
#define REG_CANTA 0x6008uL   // transmitted and acknowledged, write 1 clears (32)
#define REG_CANAA 0x600AuL   // request taken back, write 1 clears (32)
#define REG_CANRMP 0x600CuL  // received message pending, write 1 clears (32)
#define REG_CANRML 0x600EuL  // a message was overwritten; cleared with RMP (32)
#define REG_CANRFP 0x6010uL  // remote frame pending, write 1 clears (32)
#define REG_CANGAM 0x6012uL  // global mask, of the 16-mailbox mode alone (32)

// ---- The module ----------------------------------------------------------------------------------------
#define REG_CANMC 0x6014uL  // master control (EALLOW, 32)
#define CANMC_SRES_MASK 0x00000020uL
#define CANMC_STM_MASK 0x00000040uL
#define CANMC_ABO_MASK 0x00000080uL
#define CANMC_DBO_MASK 0x00000400uL
#define CANMC_PDR_MASK 0x00000800uL
#define CANMC_CCR_MASK 0x00001000uL
#define CANMC_SCB_MASK 0x00002000uL
#define CANMC_TCC_MASK 0x00004000uL
#define CANMC_MBCC_MASK 0x00008000uL
#define CANMC_SUSP_MASK 0x00010000uL
#define REG_CANBTC 0x6016uL  // bit timing, each field less 1 (EALLOW, 32)
#define CANBTC_TSEG2REG_LSB 0
#define CANBTC_TSEG2REG_MASK 0x00000007uL
#define CANBTC_TSEG1REG_LSB 3
#define CANBTC_TSEG1REG_MASK 0x00000078uL
#define CANBTC_SAM_MASK 0x00000080uL
#define CANBTC_SJWREG_LSB 8
#define CANBTC_SJWREG_MASK 0x00000300uL
#define CANBTC_BRPREG_LSB 16
#define CANBTC_BRPREG_MASK 0x00FF0000uL
#define REG_CANES 0x6018uL  // errors (write 1 clears) and status (32)
#define CANES_TM_MASK 0x00000001uL
#define CANES_RM_MASK 0x00000002uL
#define CANES_CCE_MASK 0x00000010uL
#define CANES_EW_MASK 0x00010000uL
#define CANES_EP_MASK 0x00020000uL
#define CANES_BO_MASK 0x00040000uL
#define CANES_ACKE_MASK 0x00080000uL
#define CANES_SE_MASK 0x00100000uL
#define CANES_CRCE_MASK 0x00200000uL
#define CANES_SA1_MASK 0x00400000uL
#define CANES_BE_MASK 0x00800000uL
#define CANES_FE_MASK 0x01000000uL
#define REG_CANTEC 0x601AuL  // transmit error counter (32)
#define REG_CANREC 0x601CuL  // receive error counter (32)
#define CAN_COUNTER_MASK 0x000000FFuL
#define REG_CANGIF0 0x601EuL  // interrupt flags of line 0, write 1 clears (32)
#define REG_CANGIM 0x6020uL   // interrupt mask, same bits from WLI on (EALLOW, 32)
#define REG_CANGIF1 0x6022uL  // interrupt flags of line 1 (32)
#define CANGIF_MIV_MASK 0x0000001FuL
#define CANGIF_WLIF_MASK 0x00000100uL
#define CANGIF_EPIF_MASK 0x00000200uL
#define CANGIF_BOIF_MASK 0x00000400uL
#define CANGIF_RMLIF_MASK 0x00000800uL
#define CANGIF_WDIF_MASK 0x00002000uL
#define CANGIF_AAIF_MASK 0x00004000uL
#define CANGIF_GMIF_MASK 0x00008000uL
#define CANGIM_I0EN_MASK 0x00000001uL
#define CANGIM_I1EN_MASK 0x00000002uL
#define CANGIM_GIL_MASK 0x00000004uL
#define REG_CANMIM 0x6024uL   // mailbox interrupt mask (EALLOW, 32)
#define REG_CANMIL 0x6026uL   // mailbox interrupt line (32)
#define REG_CANOPC 0x6028uL   // protects a pending message from the next one (32)
#define REG_CANTIOC 0x602AuL  // transmit pin (EALLOW, 32)
#define CANTIOC_TXFUNC_MASK 0x00000008uL
#define REG_CANRIOC 0x602CuL  // receive pin (EALLOW, 32)
#define CANRIOC_RXFUNC_MASK 0x00000008uL
#define REG_CANTSC 0x602EuL  // time stamp counter, bits on the bus (EALLOW, 32)
#define REG_CANTOC 0x6030uL  // time-out enable (32)
#define REG_CANTOS 0x6032uL  // time-out status (32)

// ---- Mailbox memory, n = 0..31 -------------------------------------------------------------------------
#define REG_CANLAM(n) ((uint32_t)(0x6040uL + 2uL * (uint32_t)(n)))   // acceptance mask, 1 is don't care (32)
#define REG_CANMOTS(n) ((uint32_t)(0x6080uL + 2uL * (uint32_t)(n)))  // time stamp (32)
#define REG_CANMOTO(n) ((uint32_t)(0x60C0uL + 2uL * (uint32_t)(n)))  // time-out value (32)
#define CANLAM_LAMI_MASK 0x80000000uL
#define REG_CANMSGID(n) ((uint32_t)(0x6100uL + 8uL * (uint32_t)(n)))  // identifier; only while disabled (32)
#define CANMSGID_EXTENDED_MASK 0x1FFFFFFFuL
#define CANMSGID_STANDARD_LSB 18
#define CANMSGID_STANDARD_MASK 0x1FFC0000uL
#define CANMSGID_AAM_MASK 0x20000000uL
#define CANMSGID_AME_MASK 0x40000000uL
#define CANMSGID_IDE_MASK 0x80000000uL
#define REG_CANMSGCTRL(n) ((uint32_t)(0x6102uL + 8uL * (uint32_t)(n)))  // undefined after reset (32)
#define CANMSGCTRL_DLC_MASK 0x0000000FuL
#define CANMSGCTRL_RTR_MASK 0x00000010uL
#define CANMSGCTRL_TPL_LSB 8
#define CANMSGCTRL_TPL_MASK 0x00001F00uL
#define REG_CANMDL(n) ((uint32_t)(0x6104uL + 8uL * (uint32_t)(n)))  // octets 0..3, 0 the highest unless DBO (32)
#define REG_CANMDH(n) ((uint32_t)(0x6106uL + 8uL * (uint32_t)(n)))  // octets 4..7 (32)

#endif
